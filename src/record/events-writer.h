// Writes every committed collision, fusion and fission as a row of CSV, in time order; a fission
// one row for each contact that broke.
//
// Frames: point (m) and normal (unit, from body1 to body2) in the world frame; impulse in N s.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

#include "kernel/world/callback.h"
#include "record/csv-file.h"
#include "record/poses-writer.h"

namespace tw {

class EventsWriter {
 public:
  // Columns: time,kind,body1,body2,x,y,z,nx,ny,nz,impulse.
  // Errors: UserError, here and in every call, when the file cannot be written.
  explicit EventsWriter(const std::string& path);

  // Must be set before the first collision.
  void set_names(BodyNames names) { names_ = std::move(names); }
  void collision(const Collision& collision);
  CsvFile& file() { return file_; }

 private:
  CsvFile file_;
  BodyNames names_;
};

}  // namespace tw
