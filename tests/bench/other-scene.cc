// Reading a dumped scene and measuring its bodies.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "other-scene.h"

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "collision/distance/separation.h"

namespace tw::bench {

namespace {

Vec3 read_vector(std::istream& in) {
  Vec3 v;
  in >> v.x() >> v.y() >> v.z();
  return v;
}

OtherBody read_body(std::istream& in) {
  OtherBody body;
  in >> body.fixed >> body.mass;
  const Vec3 diagonal = read_vector(in), rest = read_vector(in);
  body.inertia << diagonal.x(), rest.x(), rest.y(), rest.x(), diagonal.y(), rest.z(), rest.y(),
      rest.z(), diagonal.z();
  body.pose.p = read_vector(in);
  in >> body.pose.q.w() >> body.pose.q.x() >> body.pose.q.y() >> body.pose.q.z();
  body.velocity = read_vector(in);
  body.angular_velocity = read_vector(in);
  std::size_t count = 0;
  in >> count;
  std::vector<Vec3> corners;
  for (std::size_t i = 0; i < count && in; ++i) corners.push_back(read_vector(in));
  if (!in) throw std::runtime_error("a body's line is too short");
  body.shape = make_hull(corners);
  return body;
}

}  // namespace

OtherScene read_scene(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file);
  OtherScene scene;
  for (std::string line, word; std::getline(in, line);) {
    std::istringstream words(line);
    words >> word;
    if (word == "gravity") scene.gravity = read_vector(words);
    if (word == "contact") words >> scene.restitution >> scene.friction;
    if (word == "body") scene.bodies.push_back(read_body(words));
  }
  return scene;
}

std::vector<OtherState> first_states(const OtherScene& scene) {
  std::vector<OtherState> states;
  for (const OtherBody& body : scene.bodies)
    states.push_back({body.pose, body.velocity, body.angular_velocity});
  return states;
}

SceneMeter::SceneMeter(const OtherScene& scene) : scene_(scene), frames_(scene.bodies.size()) {
  Aabb ground;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const OtherBody& body = scene.bodies[i];
    place(i, body.pose);
    if (body.fixed) ground.add(body.shape->bounds(frames_[i]));
  }
  floor_ = ground.lo.z();
}

void SceneMeter::place(std::size_t index, const Pose& pose) {
  frames_[index] = Frame(pose);
  hash_.place(static_cast<std::uint32_t>(index),
              scene_.bodies[index].shape->bounds(frames_[index]));
}

void SceneMeter::measure(std::size_t index, const OtherState& state) {
  const OtherBody& body = scene_.bodies[index];
  // T + V = m v.v / 2 + w.(R I R^T w) / 2 - m g.x
  const Vec3 w = frames_[index].R.transpose() * state.angular_velocity;
  energy_ += 0.5 * body.mass * state.velocity.squaredNorm() + 0.5 * w.dot(body.inertia * w) -
             body.mass * scene_.gravity.dot(state.pose.p);
  bool inside = state.pose.p.z() < floor_;
  hash_.overlapping(static_cast<std::uint32_t>(index), [&](std::uint32_t other) {
    const OtherBody& partner = scene_.bodies[other];
    const double gap =
        separation(*body.shape, frames_[index], *partner.shape, frames_[other]).distance;
    if (-gap > depth_) {
      depth_ = -gap;
      deepest_ = {index, other};
    }
    int face = 0;
    if (partner.fixed &&
        partner.hull().face_separation(frames_[other].to_local(state.pose.p), face) < 0)
      inside = true;
  });
  lost_ += inside;
}

void SceneMeter::look(const std::vector<OtherState>& states) {
  depth_ = energy_ = 0;
  deepest_ = {};
  lost_ = 0;
  for (std::size_t i = 0; i < states.size(); ++i)
    if (!scene_.bodies[i].fixed) place(i, states[i].pose);
  for (std::size_t i = 0; i < states.size(); ++i)
    if (!scene_.bodies[i].fixed) measure(i, states[i]);
}

}  // namespace tw::bench
