// Cost of distance queries and contact manifolds, per pair of shapes and situation.
//
// Poses turn by 0.01 rad from query to query, as between neighbouring times of a simulation; the
// gap is a tenth of the size (apart), or the depth a thousandth (shallow).  CPU time.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <benchmark/benchmark.h>

#include <random>

#include "collision/distance/separation.h"

namespace tw {
namespace {

enum class Situation { apart, shallow };

ShapePtr rock(int points, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Vec3> cloud;
  for (int i = 0; i < points; ++i) {
    const double x = normal(random);
    const double y = normal(random);
    const double z = normal(random);
    cloud.push_back(0.5 * Vec3(x, y, z).normalized());
  }
  return make_hull(cloud);
}

ShapePtr molecule() {
  return make_union({place_shape(make_sphere(0.3), {{0.2, 0, 0}, Quat::Identity()}),
                     place_shape(make_sphere(0.25), {{-0.2, 0, 0}, Quat::Identity()})});
}

// Frames of b along a slow tumble, each at the wanted gap from a at the origin.
std::vector<Frame> tumble(const Shape& a, const Shape& b, double gap) {
  std::vector<Frame> frames;
  for (int i = 0; i < 256; ++i) {
    Pose pose;
    pose.q = rotation_by(0.01 * i * Vec3(0.36, 0.48, 0.8));
    pose.p = 3 * Vec3(std::cos(0.007 * i), std::sin(0.007 * i), 0.2).normalized();
    Frame frame(pose);
    const Separation s = separation(a, Frame(), b, frame);
    frame.p -= (s.distance - gap) * s.normal;
    frames.push_back(frame);
  }
  return frames;
}

double gap_of(Situation situation) { return situation == Situation::apart ? 0.1 : -1e-3; }

void cold(benchmark::State& state, const ShapePtr& a, const ShapePtr& b, Situation situation) {
  const std::vector<Frame> frames = tumble(*a, *b, gap_of(situation));
  const Frame origin;
  std::size_t i = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(separation(*a, origin, *b, frames[i++ % frames.size()]));
}

void warm(benchmark::State& state, const ShapePtr& a, const ShapePtr& b) {
  const std::vector<Frame> frames = tumble(*a, *b, gap_of(Situation::apart));
  const Frame origin;
  SimplexCache cache;
  std::size_t i = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(
        part_separation(a->parts()[0], origin, b->parts()[0], frames[i++ % frames.size()], &cache));
}

void manifold(benchmark::State& state, const ShapePtr& a, const ShapePtr& b, Situation situation) {
  const std::vector<Frame> frames = tumble(*a, *b, gap_of(situation));
  const Frame origin;
  std::vector<ContactPoint> points;
  std::size_t i = 0;
  for (auto _ : state) {
    points.clear();
    touching_points(*a, origin, *b, frames[i++ % frames.size()], 1e-2, points);
    benchmark::DoNotOptimize(points.data());
  }
}

void register_pair(const std::string& name, const ShapePtr& a, const ShapePtr& b) {
  using benchmark::RegisterBenchmark;
  RegisterBenchmark((name + "/cold").c_str(), cold, a, b, Situation::apart);
  RegisterBenchmark((name + "/warm").c_str(), warm, a, b);
  RegisterBenchmark((name + "/shallow").c_str(), cold, a, b, Situation::shallow);
  RegisterBenchmark((name + "/manifold").c_str(), manifold, a, b, Situation::shallow);
}

void register_all() {
  const ShapePtr ball = make_sphere(0.5);
  const ShapePtr box = make_box({1, 0.8, 0.6});
  const ShapePtr ground = make_half_space({0, 0, 1}, 0);
  register_pair("sphere-sphere", ball, ball);
  register_pair("molecule-molecule", molecule(), molecule());
  register_pair("box-sphere", box, ball);
  register_pair("box-molecule", box, molecule());
  register_pair("rock24-sphere", rock(24, 1), ball);
  register_pair("ground-rock24", ground, rock(24, 1));
  register_pair("box-box", box, box);
  register_pair("rock8-rock8", rock(8, 2), rock(8, 3));
  register_pair("rock24-rock24", rock(24, 4), rock(24, 5));
  register_pair("rock64-rock64", rock(64, 6), rock(64, 7));
  register_pair("rock200-rock200", rock(200, 8), rock(200, 9));
}

}  // namespace
}  // namespace tw

int main(int argc, char** argv) {
  tw::register_all();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
