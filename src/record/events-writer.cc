// Writes every committed collision, fusion and fission as a row of CSV.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "record/events-writer.h"

namespace tw {

namespace {

const char* kind_name(CollisionKind kind) {
  switch (kind) {
    case CollisionKind::fusion: return "fusion";
    case CollisionKind::fission: return "fission";
    default: return "collision";
  }
}

}  // namespace

EventsWriter::EventsWriter(const std::string& path)
    : file_(path, "time,kind,body1,body2,x,y,z,nx,ny,nz,impulse") {}

void EventsWriter::collision(const Collision& collision) {
  file_.number(collision.time);
  file_.text(kind_name(collision.kind));
  file_.text(names_(collision.body1));
  file_.text(names_(collision.body2));
  for (const Vec3* v : {&collision.point, &collision.normal})
    for (int i = 0; i < 3; ++i) file_.number((*v)[i]);
  file_.number(collision.impulse);
  file_.end_row();
}

}  // namespace tw
