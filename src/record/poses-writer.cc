// Writes the poses of all moving bodies as CSV.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "record/poses-writer.h"

namespace tw {

PosesWriter::PosesWriter(const std::string& path)
    : file_(path, "time,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz") {}

void PosesWriter::frame(long, double frame_time, std::span<const BodyPose> poses) {
  ++frames_;
  for (const BodyPose& pose : poses) {
    const BodyState& s = pose.state;
    file_.number(frame_time);
    file_.text(names_(pose.body));
    for (const double x : {s.position.x(), s.position.y(), s.position.z()}) file_.number(x);
    for (const double q :
         {s.orientation.w(), s.orientation.x(), s.orientation.y(), s.orientation.z()})
      file_.number(q);
    for (const double v : {s.velocity.x(), s.velocity.y(), s.velocity.z()}) file_.number(v);
    for (const double w : {s.angular_velocity.x(), s.angular_velocity.y(), s.angular_velocity.z()})
      file_.number(w);
    file_.end_row();
  }
}

}  // namespace tw
