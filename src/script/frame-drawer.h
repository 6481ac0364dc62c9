// Feeds the frames of a run to the drawing thread.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <unordered_map>
#include <vector>

#include "kernel/world/world.h"
#include "render/frame-pipeline.h"

namespace tw {

// Of every `parts` frames one is drawn, the `part`-th (from 1), so that several runs can share
// them.
struct FrameShare {
  long part = 1, parts = 1;
  bool includes(long index) const { return index % parts == part - 1; }
};

class FrameDrawer : public FrameSink {
 public:
  // Opens the drawing library.  `scene` holds the world's bodies at present; `contacts`: they are
  // drawn.  `settings` numbers the frames of the share.
  FrameDrawer(const World& world, const FrameSettings& settings, const FrameShare& share,
              DrawScene scene, std::vector<HudLine> hud, bool contacts);

  void frame(long index, double frame_time, std::span<const BodyPose> poses) override;
  // From the next frame on.
  void set_looks(const Camera& camera, const Light& light, const Sky& sky);
  FramePipeline& pipeline() { return pipeline_; }
  // How many frames have come so far, drawn or not.
  long frames() const { return frames_; }

 private:
  void note_roster();

  const World& world_;
  FrameShare share_;
  DrawFrame next_;           // what has changed since the last frame that was drawn
  std::vector<Pose> poses_;  // by place in the picture's list, as last known
  std::vector<HudLine> hud_;
  bool contacts_;
  long frames_ = 0;
  // A body that was ever drawn has a place of its own, which is its number where no restore gave
  // that to another.
  std::unordered_map<std::uint64_t, std::size_t> places_;  // by serial number
  std::vector<std::size_t> place_of_;                      // by body, of those there are
  FramePipeline pipeline_;
};

// All bodies of a world as they are now; camera, light and sky are the defaults.
DrawScene draw_scene(const World& world);
DrawBody draw_body(const World& world, BodyId id);

// Adds the contacts of a world to a frame of its present, or of the time of the frame that a sink
// is being handed: a line for each that carries load, and lines of the HUD.
void add_contacts(DrawFrame& frame, const World& world);

}  // namespace tw
