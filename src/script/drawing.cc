// Scheme primitives: drawing frames and single pictures.
//
// Without drawing compiled in only %drawing? is there, and says so.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "script/file-names.h"
#include "script/primitive.h"
#include "script/types.h"
#include "script/values.h"

#ifdef TW_RENDER
#include "render/whole-file.h"
#include "script/frame-drawer.h"
#endif

namespace tw {

TW_PRIMITIVES(define_drawing_primitives)

#ifndef TW_RENDER

TW_PRIMITIVE(can_draw, "%drawing?", (), "Is drawing compiled in?") { return SCM_BOOL_F; }

void define_drawing() { define_drawing_primitives(); }

#else

TW_PRIMITIVE(can_draw, "%drawing?", (), "Is drawing compiled in?") { return SCM_BOOL_T; }

namespace {

struct DrawerBox : Live<LiveKind::recorder> {
  FrameSettings settings;
  std::shared_ptr<FrameDrawer> drawer;  // once attached
};

SCM drawer_type = SCM_BOOL_F;

void finalize_drawer(SCM object) {
  delete static_cast<DrawerBox*>(scm_foreign_object_ref(object, 0));
  scm_foreign_object_set_x(object, 0, nullptr);
}

DrawerBox& to_drawer(SCM object) {
  if (!SCM_STRUCTP(object) || !scm_is_eq(SCM_STRUCT_VTABLE(object), drawer_type))
    throw BadValue{"the drawer", object, "a drawer of frames"};
  return *static_cast<DrawerBox*>(scm_foreign_object_ref(object, 0));
}

// The value of a symbol in an alist, #f if it is not there.
SCM entry(SCM alist, const char* name) { return scm_assq_ref(alist, scm_from_utf8_symbol(name)); }

template <class Target>
void set_vec3(Target& target, SCM alist, const char* name) {
  const SCM value = entry(alist, name);
  if (scm_is_true(value)) target = to_vec3(value, name);
}

Camera to_camera(SCM world, SCM alist) {
  Camera camera;
  set_vec3(camera.eye, alist, "eye");
  set_vec3(camera.target, alist, "target");
  set_vec3(camera.up, alist, "up");
  if (scm_is_true(entry(alist, "fov"))) camera.fov = to_real(entry(alist, "fov"), "fov");
  if (scm_is_true(entry(alist, "follow")))
    camera.follow = to_body(world, entry(alist, "follow"), "follow");
  set_vec3(camera.follow_from, alist, "follow-from");
  if (scm_is_true(entry(alist, "turn"))) camera.turn = to_real(entry(alist, "turn"), "turn");
  if (const SCM bounds = entry(alist, "in-view"); scm_is_true(bounds)) {
    camera.in_view.emplace();
    camera.in_view->add(to_vec3(SCM_CAR(bounds), "in-view"));
    camera.in_view->add(to_vec3(SCM_CADR(bounds), "in-view"));
  }
  return camera;
}

Light to_light(SCM alist) {
  Light light;
  set_vec3(light.direction, alist, "direction");
  set_vec3(light.color, alist, "color");
  return light;
}

Sky to_sky(SCM alist) {
  Sky sky;
  set_vec3(sky.zenith, alist, "zenith");
  set_vec3(sky.horizon, alist, "horizon");
  set_vec3(sky.ground, alist, "ground");
  if (scm_is_true(entry(alist, "fog"))) sky.fog = to_real(entry(alist, "fog"), "fog");
  if (scm_is_true(entry(alist, "grain"))) sky.grain = to_real(entry(alist, "grain"), "grain");
  return sky;
}

Quality to_quality(SCM value) {
  const std::string text = to_symbol_name(value, "quality");
  if (text == "draft") return Quality::draft;
  if (text == "normal") return Quality::normal;
  if (text == "best") return Quality::best;
  throw BadValue{"quality", value, "draft, normal or best"};
}

int to_side(SCM value) {
  const long side = to_integer(value, "a side of the picture");
  TW_REQUIRE(side >= 1 && side <= 16384,
             "a side of the picture is " + std::to_string(side) + "; expected 1 to 16384 pixels");
  return static_cast<int>(side);
}

RenderSettings to_render_settings(SCM width, SCM height, SCM quality, SCM overlay) {
  RenderSettings settings;
  settings.hud = to_bool(overlay);
  settings.size = {to_side(width), to_side(height)};
  settings.quality = to_quality(quality);
  check_size(settings.size, settings.quality);
  return settings;
}

// `looks` is (camera light sky), each an alist.
DrawScene scene_of(SCM world, SCM looks) {
  DrawScene scene = draw_scene(to_world(world));
  scene.camera = to_camera(world, SCM_CAR(looks));
  scene.light = to_light(SCM_CADR(looks));
  scene.sky = to_sky(SCM_CADDR(looks));
  return scene;
}

// Frame k is at k/fps: the first that is not before the world's time.
long first_frame(const World& world, double fps) {
  auto k = static_cast<long>(std::floor(world.time() * fps));
  while (static_cast<double>(k) / fps < world.time()) ++k;
  return k;
}

// (PART PARTS), or #f for all frames.
FrameShare to_share(SCM value) {
  if (scm_is_false(value)) return {};
  return {to_integer(SCM_CAR(value), "the part"), to_integer(SCM_CADR(value), "the parts")};
}

std::vector<HudLine> hud_lines(SCM title) {
  if (!scm_is_string(title)) return {};
  return {text_of(title)};
}

}  // namespace

// Refuses at once what no run could draw or write; the drawing library is not opened yet.
TW_PRIMITIVE(open_frames, "%open-frames",
             (SCM frames, SCM movie, SCM width, SCM height, SCM quality, SCM overlay),
             "Prepare drawing frames into a folder, a movie or both.") {
  auto box = std::make_unique<DrawerBox>();
  if (scm_is_true(frames)) box->settings.frames = to_file_name(frames, "the folder for frames");
  if (scm_is_true(movie)) box->settings.movie = to_file_name(movie, "the movie");
  box->settings.render = to_render_settings(width, height, quality, overlay);
  check_frames(box->settings);
  return scm_make_foreign_object_1(drawer_type, box.release());
}

TW_PRIMITIVE(attach_frames, "%attach-frames!",
             (SCM world, SCM object, SCM fps, SCM share, SCM looks, SCM title, SCM contacts),
             "Let a world feed the drawer with all frames or its share of them.") {
  World& w = to_world(world);
  DrawerBox& box = to_drawer(object);
  const double rate = to_real(fps, "fps");
  const FrameShare of_frames = to_share(share);
  box.settings.fps = rate;
  box.settings.first_frame = first_frame(w, rate);
  while (!of_frames.includes(box.settings.first_frame)) ++box.settings.first_frame;
  box.settings.stride = of_frames.parts;
  box.drawer = std::make_shared<FrameDrawer>(w, box.settings, of_frames, scene_of(world, looks),
                                             hud_lines(title), to_bool(contacts));
  w.add_frame_sink(box.drawer, rate);
  return SCM_UNSPECIFIED;
}

TW_PRIMITIVE(set_looks, "%set-looks!", (SCM world, SCM object, SCM looks),
             "Let frames from now on have other looks.") {
  const DrawerBox& box = to_drawer(object);
  if (!box.drawer) return SCM_UNSPECIFIED;
  box.drawer->set_looks(to_camera(world, SCM_CAR(looks)), to_light(SCM_CADR(looks)),
                        to_sky(SCM_CADDR(looks)));
  return SCM_UNSPECIFIED;
}

TW_PRIMITIVE(frames_written, "%frames-written", (SCM object), "Return how many are on disk.") {
  const DrawerBox& box = to_drawer(object);
  return scm_from_long(box.drawer ? box.drawer->pipeline().frames_written() : 0);
}

TW_PRIMITIVE(await_frames, "%await-frames", (SCM object, SCM most, SCM seconds),
             "Wait until at most so many frames are not on disk, or that long; tell whether they "
             "are so few.") {
  const DrawerBox& box = to_drawer(object);
  if (!box.drawer) return SCM_BOOL_T;
  const auto left = static_cast<std::size_t>(to_integer(most, "the number of frames"));
  return scm_from_bool(box.drawer->pipeline().wait(left, to_real(seconds, "the time to wait")));
}

TW_PRIMITIVE(finish_frames, "%finish-frames!", (SCM world, SCM object, SCM seconds),
             "Take no more frames and wait until all are on disk and a movie is whole, or that "
             "long; tell whether they are.") {
  const DrawerBox& box = to_drawer(object);
  if (!box.drawer) return SCM_BOOL_T;
  to_world(world).remove_frame_sink(box.drawer.get());
  return scm_from_bool(box.drawer->pipeline().finish(to_real(seconds, "the time to wait")));
}

TW_PRIMITIVE(close_frames, "%close-frames!", (SCM world, SCM object, SCM all),
             "Stop drawing, when all frames are written or only the one in hand.") {
  DrawerBox& box = to_drawer(object);
  const std::shared_ptr<FrameDrawer> drawer = std::move(box.drawer);
  box.drawer.reset();
  if (!drawer) return SCM_UNSPECIFIED;
  WorldBox& world_box = to_world_box(world);
  world_box.world.remove_frame_sink(drawer.get());
  world_box.frames = std::max<std::int64_t>(world_box.frames, drawer->frames());
  if (to_bool(all))
    drawer->pipeline().finish();
  else
    drawer->pipeline().abandon();
  world_box.draw_cpu_seconds += drawer->pipeline().draw_cpu_seconds();
  return SCM_UNSPECIFIED;
}

TW_PRIMITIVE(check_picture, "%check-picture", (SCM file, SCM width, SCM height, SCM quality),
             "Refuse a picture that could not be drawn or written; make its folder.") {
  to_render_settings(width, height, quality, SCM_BOOL_T);
  make_writable_folder(folder_of(to_file_name(file, "the picture's file")));
  return SCM_UNSPECIFIED;
}

TW_PRIMITIVE(bounds_in_view, "%bounds-in-view", (SCM world),
             "Return two corners of the box that a camera without eye and target shows.") {
  std::vector<Pose> poses;
  const std::vector<DrawBody> bodies = draw_scene(to_world(world)).bodies;
  for (const DrawBody& body : bodies) poses.push_back(body.pose);
  const Aabb bounds = scene_bounds(bodies, poses);
  return scm_list_2(from_vec3(bounds.lo), from_vec3(bounds.hi));
}

TW_PRIMITIVE(render, "%render!",
             (SCM world, SCM file, SCM width, SCM height, SCM quality, SCM overlay, SCM looks,
              SCM title, SCM contacts),
             "Draw the world as it is now.") {
  require_outside_callbacks("render!");
  const World& w = to_world(world);
  const DrawScene scene = scene_of(world, looks);
  DrawFrame frame;
  frame.time = w.time();
  for (const DrawBody& body : scene.bodies) frame.poses.push_back(body.pose);
  frame.hud = hud_lines(title);
  if (to_bool(contacts)) add_contacts(frame, w);
  render_image(to_file_name(file, "the picture's file"),
               to_render_settings(width, height, quality, overlay), scene, frame);
  return SCM_UNSPECIFIED;
}

void define_drawing() {
  define_drawing_primitives();
  drawer_type = scm_gc_protect_object(scm_make_foreign_object_type(
      scm_from_utf8_symbol("<drawer>"), scm_list_1(scm_from_utf8_symbol("box")), finalize_drawer));
}

#endif

}  // namespace tw
