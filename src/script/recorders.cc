// Scheme primitives: recorders that stream poses and events to CSV files.
//
// That a file can be written is seen when its recorder is opened, before the scene is loaded; it is
// made when the run begins and the recorder is attached to a world: a scene that cannot be loaded
// leaves what was in it.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>

#include "record/events-writer.h"
#include "record/poses-writer.h"
#include "script/file-names.h"
#include "script/primitive.h"
#include "script/types.h"
#include "script/values.h"

namespace tw {

TW_PRIMITIVES(define_recorders)

namespace {

struct Recorder : Live<LiveKind::recorder> {
  std::string poses_path, events_path;  // of one that is open
  std::shared_ptr<PosesWriter> poses;
  std::shared_ptr<EventsWriter> events;
  // of one that is attached
  CsvFile& file() { return poses ? poses->file() : events->file(); }
};

SCM recorder_type = SCM_BOOL_F;

void finalize_recorder(SCM object) {
  delete static_cast<Recorder*>(scm_foreign_object_ref(object, 0));
  scm_foreign_object_set_x(object, 0, nullptr);
}

Recorder& to_recorder(SCM object) {
  if (!SCM_STRUCTP(object) || !scm_is_eq(SCM_STRUCT_VTABLE(object), recorder_type))
    throw BadValue{"the recorder", object, "a recorder"};
  return *static_cast<Recorder*>(scm_foreign_object_ref(object, 0));
}

SCM from_recorder(Recorder* recorder) { return scm_make_foreign_object_1(recorder_type, recorder); }

BodyNames names_of(const World& world) {
  return [&world](BodyId id) { return world.body(id).name; };
}

}  // namespace

void define_recorder_type() {
  recorder_type = scm_gc_protect_object(
      scm_make_foreign_object_type(scm_from_utf8_symbol("<recorder>"),
                                   scm_list_1(scm_from_utf8_symbol("box")), finalize_recorder));
}

TW_PRIMITIVE(open_poses, "%open-poses", (SCM path), "Open a file for poses.") {
  auto recorder = std::make_unique<Recorder>();
  recorder->poses_path = to_file_name(path, "the poses file");
  require_writable(recorder->poses_path);
  return from_recorder(recorder.release());
}

TW_PRIMITIVE(open_events, "%open-events", (SCM path), "Open a file for events.") {
  auto recorder = std::make_unique<Recorder>();
  recorder->events_path = to_file_name(path, "the events file");
  require_writable(recorder->events_path);
  return from_recorder(recorder.release());
}

TW_PRIMITIVE(attach_recorder, "%attach-recorder!", (SCM world, SCM object, SCM fps),
             "Let a world feed the recorder.") {
  World& w = to_world(world);
  Recorder& recorder = to_recorder(object);
  TW_REQUIRE(!recorder.poses_path.empty() || !recorder.events_path.empty(),
             "the recorder is closed; expected an open one");
  if (!recorder.poses_path.empty()) {
    if (!recorder.poses) recorder.poses = std::make_shared<PosesWriter>(recorder.poses_path);
    recorder.poses->set_names(names_of(w));
    w.add_frame_sink(recorder.poses, to_real(fps, "fps"));
  } else {
    if (!recorder.events) recorder.events = std::make_shared<EventsWriter>(recorder.events_path);
    recorder.events->set_names(names_of(w));
    // observers stay with the world: a closed recorder is one that nobody else holds
    for (const CollisionKind kind :
         {CollisionKind::collision, CollisionKind::fusion, CollisionKind::fission})
      w.add_collision_observer(
          [writer = std::weak_ptr<EventsWriter>(recorder.events)](const Collision& collision) {
            if (const auto open = writer.lock()) open->collision(collision);
          },
          kind);
  }
  return SCM_UNSPECIFIED;
}

TW_PRIMITIVE(flush_recorder, "%flush-recorder!", (SCM object), "Bring everything to the file.") {
  Recorder& recorder = to_recorder(object);
  if (recorder.poses || recorder.events) recorder.file().flush();
  return SCM_UNSPECIFIED;
}

TW_PRIMITIVE(close_recorder, "%close-recorder!", (SCM world, SCM object),
             "Detach a recorder and close its file.") {
  Recorder& recorder = to_recorder(object);
  const auto poses = std::move(recorder.poses);
  const auto events = std::move(recorder.events);
  recorder.poses.reset();
  recorder.events.reset();
  recorder.poses_path.clear();
  recorder.events_path.clear();
  if (poses) {
    WorldBox& box = to_world_box(world);
    box.world.remove_frame_sink(poses.get());
    box.frames = std::max<std::int64_t>(box.frames, poses->frames());
  }
  if (poses) poses->file().close();
  if (events) events->file().close();
  return SCM_UNSPECIFIED;
}

}  // namespace tw
