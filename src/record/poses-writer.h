// Writes the poses of all moving bodies at every frame time as CSV: one row per body and frame.
//
// Frames: position and orientation of the body frame, velocity of the centre of mass, world, SI.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>
#include <string>

#include "kernel/world/callback.h"
#include "record/csv-file.h"

namespace tw {

using BodyNames = std::function<std::string(BodyId)>;

class PosesWriter : public FrameSink {
 public:
  // Columns: time,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz.
  // Errors: UserError, here and in every call, when the file cannot be written.
  explicit PosesWriter(const std::string& path);

  // Must be set before the first frame; called once per row.
  void set_names(BodyNames names) { names_ = std::move(names); }
  void frame(long index, double frame_time, std::span<const BodyPose> poses) override;
  CsvFile& file() { return file_; }
  // How many frames have come so far.
  long frames() const { return frames_; }

 private:
  CsvFile file_;
  BodyNames names_;
  long frames_ = 0;
};

}  // namespace tw
