// Entry of the extension libguile-timewarp: defines all primitives in the current module.
//
// The executable registers the same function, so that (timewarp primitives) finds it built in.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "script/init.h"

#include "script/types.h"

namespace tw {

void define_border();
void define_compiled_code();
void define_exits();
void define_shapes();
void define_bodies();
void define_states();
void define_multibodies();
void define_urdf();
void define_joints();
void define_contact();
void define_callbacks();
void define_collisions();
void define_contacts();
void define_queries();
void define_sensors();
void define_forces();
void define_worlds();
void define_motions();
void define_recorder_type();
void define_recorders();
void define_versions();
void define_drawing();
void define_file_names();
void define_json();

}  // namespace tw

extern "C" void tw_init_guile() {
  tw::define_types();
  tw::define_border();
  tw::define_compiled_code();
  tw::define_exits();
  tw::define_shapes();
  tw::define_bodies();
  tw::define_states();
  tw::define_multibodies();
  tw::define_urdf();
  tw::define_joints();
  tw::define_contact();
  tw::define_callbacks();
  tw::define_collisions();
  tw::define_contacts();
  tw::define_queries();
  tw::define_sensors();
  tw::define_forces();
  tw::define_worlds();
  tw::define_motions();
  tw::define_recorder_type();
  tw::define_recorders();
  tw::define_versions();
  tw::define_drawing();
  tw::define_file_names();
  tw::define_json();
}
