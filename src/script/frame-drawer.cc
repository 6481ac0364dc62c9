// Feeds the frames of a run to the drawing thread.
// SPDX-License-Identifier: LGPL-3.0-or-later
#ifdef TW_RENDER
#include "script/frame-drawer.h"

#include <utility>

namespace tw {

DrawBody draw_body(const World& world, BodyId id) {
  const BodyInfo& info = world.body(id);
  const BodyState state = world.state(id);
  DrawBody body;
  body.shape = info.shape;
  body.pose = {state.position, state.orientation};
  body.color = info.color;
  body.fixed = info.kind == BodyKind::fixed;
  body.visible = info.visible;
  body.name = info.name;
  return body;
}

DrawScene draw_scene(const World& world) {
  DrawScene scene;
  for (BodyId id = 0; id < world.body_count(); ++id) scene.bodies.push_back(draw_body(world, id));
  return scene;
}

static std::vector<Pose> poses_of(const DrawScene& scene) {
  std::vector<Pose> poses;
  for (const DrawBody& body : scene.bodies) poses.push_back(body.pose);
  return poses;
}

FrameDrawer::FrameDrawer(const World& world, const FrameSettings& settings, const FrameShare& share,
                         DrawScene scene, std::vector<HudLine> hud, bool contacts)
    : world_(world),
      share_(share),
      poses_(poses_of(scene)),
      hud_(std::move(hud)),
      contacts_(contacts),
      pipeline_(settings, scene) {}

// Also where the frame is not drawn: the next one that is must know who came and went.
void FrameDrawer::note_bodies(std::span<const BodyPose> poses) {
  for (auto id = static_cast<BodyId>(poses_.size()); id < world_.body_count(); ++id) {
    next_.added.push_back(draw_body(world_, id));
    poses_.push_back(next_.added.back().pose);
  }
  if (world_.removals() > removals_) {
    next_.removed.clear();
    for (BodyId id = 0; id < poses_.size(); ++id)
      if (world_.body(id).removed) next_.removed.push_back(id);
  }
  removals_ = world_.removals();
  for (const BodyPose& pose : poses)
    poses_[pose.body] = {pose.state.position, pose.state.orientation};
}

void FrameDrawer::set_looks(const Camera& camera, const Light& light, const Sky& sky) {
  next_.camera = camera;
  next_.light = light;
  next_.sky = sky;
}

void FrameDrawer::frame(long index, double frame_time, std::span<const BodyPose> poses) {
  ++frames_;
  note_bodies(poses);
  if (!share_.includes(index)) return;
  DrawFrame frame = std::exchange(next_, {});
  frame.time = frame_time;
  frame.poses = poses_;
  frame.hud = hud_;
  if (contacts_) add_contacts(frame, world_);
  pipeline_.submit(std::move(frame));
}

}  // namespace tw
#endif
