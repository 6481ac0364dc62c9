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
  body.visual = info.visual;
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

constexpr std::size_t nowhere = ~std::size_t{0};  // place of a body that was removed

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
      pipeline_(settings, scene) {
  for (BodyId id = 0; id < poses_.size(); ++id) places_.emplace(world.serial(id), id);
}

// Also where the frame is not drawn: the next one that is must know who came and went.
void FrameDrawer::note_roster() {
  std::vector<std::size_t> places;
  for (BodyId id = 0; id < world_.body_count(); ++id) {
    const auto [known, is_new] = places_.try_emplace(world_.serial(id), poses_.size());
    if (is_new) {
      next_.added.push_back(draw_body(world_, id));
      poses_.push_back(next_.added.back().pose);
    }
    places.push_back(world_.body(id).removed ? nowhere : known->second);
  }
  if (places == place_of_) return;
  place_of_ = std::move(places);
  std::vector<bool> seen(poses_.size(), false);
  for (const std::size_t place : place_of_)
    if (place != nowhere) seen[place] = true;
  next_.removed.emplace();
  for (std::size_t place = 0; place < seen.size(); ++place)
    if (!seen[place]) next_.removed->push_back(place);
}

void FrameDrawer::set_looks(const Camera& camera, const Light& light, const Sky& sky) {
  next_.camera = camera;
  // the body is there, but may have come since the last frame
  note_roster();
  if (camera.follow) next_.camera->follow = place_of_[*camera.follow];
  next_.light = light;
  next_.sky = sky;
}

void FrameDrawer::frame(long index, double frame_time, std::span<const BodyPose> poses) {
  ++frames_;
  note_roster();
  for (const BodyPose& pose : poses)
    if (const std::size_t place = place_of_[pose.body]; place != nowhere)
      poses_[place] = {pose.state.position, pose.state.orientation};
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
