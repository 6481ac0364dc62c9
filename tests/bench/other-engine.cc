// Reading, stepping and measuring for the programs that run the avalanche in other engines.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "other-engine.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "bench-tools.h"
#include "collision/separation.h"
#include "collision/spatial-hash.h"

namespace tw::bench {

namespace {

constexpr long frames_per_second = 30;

[[noreturn]] void usage(const char* program) {
  std::fprintf(stderr,
               "usage: %s FILE [--until=SECONDS] [--rate=HZ] [--iterations=N] [--sleep]\n"
               "       [--poses=FILE.csv]     FILE is written by dump-bodies.scm\n",
               program);
  std::exit(2);
}

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

// Overlaps, energy and losses of the scene as the engine has it now.
class Meter {
 public:
  Meter(const OtherEngine& engine, const OtherScene& scene);
  // Looks at the engine's present state.
  void look();
  double depth() const { return depth_; }    // deepest overlap, m
  double energy() const { return energy_; }  // kinetic and potential, J
  // Moving bodies whose centre is inside a fixed one or below all of them.
  int lost() const { return lost_; }
  const std::vector<OtherState>& states() const { return states_; }

 private:
  void place(std::size_t index);
  void measure(std::size_t index);

  const OtherEngine& engine_;
  const OtherScene& scene_;
  std::vector<OtherState> states_;
  std::vector<Frame> frames_;
  SpatialHash hash_;
  double floor_ = 0;  // below it nothing is fixed
  double depth_ = 0, energy_ = 0;
  int lost_ = 0;
};

Meter::Meter(const OtherEngine& engine, const OtherScene& scene)
    : engine_(engine), scene_(scene), states_(scene.bodies.size()), frames_(scene.bodies.size()) {
  Aabb ground;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const OtherBody& body = scene.bodies[i];
    states_[i] = {body.pose, body.velocity, body.angular_velocity};
    place(i);
    if (body.fixed) ground.add(body.shape->bounds(frames_[i]));
  }
  floor_ = ground.lo.z();
}

void Meter::place(std::size_t index) {
  frames_[index] = Frame(states_[index].pose);
  hash_.place(static_cast<std::uint32_t>(index), scene_.bodies[index].shape->bounds(frames_[index]));
}

void Meter::measure(std::size_t index) {
  const OtherBody& body = scene_.bodies[index];
  const OtherState& state = states_[index];
  // T + V = m v.v / 2 + w.(R I R^T w) / 2 - m g.x
  const Vec3 w = frames_[index].R.transpose() * state.angular_velocity;
  energy_ += 0.5 * body.mass * state.velocity.squaredNorm() + 0.5 * w.dot(body.inertia * w) -
             body.mass * scene_.gravity.dot(state.pose.p);
  bool inside = state.pose.p.z() < floor_;
  hash_.overlapping(static_cast<std::uint32_t>(index), [&](std::uint32_t other) {
    const OtherBody& partner = scene_.bodies[other];
    const double gap =
        separation(*body.shape, frames_[index], *partner.shape, frames_[other]).distance;
    depth_ = std::max(depth_, -gap);
    int face = 0;
    if (partner.fixed &&
        partner.hull().face_separation(frames_[other].to_local(state.pose.p), face) < 0)
      inside = true;
  });
  lost_ += inside;
}

void Meter::look() {
  depth_ = energy_ = 0;
  lost_ = 0;
  for (std::size_t i = 0; i < states_.size(); ++i)
    if (!scene_.bodies[i].fixed) {
      states_[i] = engine_.state(i);
      place(i);
    }
  for (std::size_t i = 0; i < states_.size(); ++i)
    if (!scene_.bodies[i].fixed) measure(i);
}

void write_poses(std::ostream& out, double time, const OtherScene& scene,
                 const std::vector<OtherState>& states) {
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (scene.bodies[i].fixed) continue;
    const auto& [pose, v, w] = states[i];
    out << time << ',' << i << ',' << pose.p.x() << ',' << pose.p.y() << ',' << pose.p.z() << ','
        << pose.q.w() << ',' << pose.q.x() << ',' << pose.q.y() << ',' << pose.q.z() << ',' << v.x()
        << ',' << v.y() << ',' << v.z() << ',' << w.x() << ',' << w.y() << ',' << w.z() << '\n';
  }
}

bool read_option(const std::string& text, OtherOptions& options) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  const std::string value = equals == std::string::npos ? "" : text.substr(equals + 1);
  if (name == "--until") options.until = std::atof(value.c_str());
  else if (name == "--rate") options.rate = std::atol(value.c_str());
  else if (name == "--iterations") options.iterations = std::atoi(value.c_str());
  else if (name == "--poses") options.poses = value;
  else if (text == "--sleep") options.sleep = true;
  else if (text[0] != '-' && options.file.empty()) options.file = text;
  else return false;
  return true;
}

}  // namespace

OtherOptions parse_options(int argc, char** argv) {
  OtherOptions options;
  for (int i = 1; i < argc; ++i)
    if (!read_option(argv[i], options)) usage(argv[0]);
  const bool sane = options.until > 0 && options.rate >= frames_per_second &&
                    options.rate % frames_per_second == 0 && options.iterations >= 0;
  if (options.file.empty() || !sane) usage(argv[0]);
  return options;
}

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

void run_other_engine(OtherEngine& engine, const OtherScene& scene, const OtherOptions& options) {
  Meter meter(engine, scene);
  meter.look();
  std::ofstream poses;
  if (!options.poses.empty()) {
    poses.open(options.poses);
    poses << "time,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n";
    write_poses(poses, 0, scene, meter.states());
  }
  std::puts("| s | CPU ms per frame | slowest frame, ms | depth so far, mm | lost | energy, MJ |\n"
            "| --- | --- | --- | --- | --- | --- |");
  std::printf("| 0 | | | %.2f | %d | %.4f |\n", 1e3 * meter.depth(), meter.lost(),
              1e-6 * meter.energy());

  const long frames = std::lround(options.until * frames_per_second);
  const long steps = options.rate / frames_per_second;
  double total = 0, recent = 0, slowest = 0, depth = 0;
  long recent_frames = 0;
  for (long frame = 1; frame <= frames; ++frame) {
    const double before = cpu_seconds();
    for (long k = 0; k < steps; ++k) engine.step(1.0 / static_cast<double>(options.rate));
    const double cost = cpu_seconds() - before;
    total += cost;
    recent += cost;
    ++recent_frames;
    slowest = std::max(slowest, cost);
    meter.look();
    depth = std::max(depth, meter.depth());
    const double time = static_cast<double>(frame) / frames_per_second;
    if (poses.is_open()) write_poses(poses, time, scene, meter.states());
    if (frame % (5 * frames_per_second) != 0 && frame != frames) continue;
    std::printf("| %g | %.2f | %.1f | %.2f | %d | %.4f |\n", time,
                1e3 * recent / static_cast<double>(recent_frames), 1e3 * slowest, 1e3 * depth,
                meter.lost(), 1e-6 * meter.energy());
    std::fflush(stdout);
    recent = 0;
    recent_frames = 0;
  }
  std::printf("all: %.2f ms per frame, deepest %.2f mm, %d lost\n",
              1e3 * total / static_cast<double>(frames), 1e3 * depth, meter.lost());
}

}  // namespace tw::bench
