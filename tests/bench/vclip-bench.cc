// V-Clip beside the kernel's distance query on the same poses: cost, answers against a proof,
// features.  Prints the Markdown tables of doc/vclip.md.
//
//   vclip-bench                                            all tables
//   vclip-bench PAIR DEGREES METHOD QUERIES                that many queries, for callgrind; METHOD
//                                                          is gjk, vclip, cold-gjk, cold-vclip or
//                                                          poses (all but the queries)
//
// A distance is proved by a slab of that width between the bodies and two of their points that far
// apart; hulls of few vertices are compared with all pairs of features as well, and the program
// fails where the kernel's query is not what they say.  Lengths are shares of the larger body's
// size.  CPU time.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "bench/vclip.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

#include "bench/bench-tools.h"
#include "collision/broad/near-parts.h"
#include "collision/distance/separation.h"
#include "unit/convex-oracles.h"

namespace tw::bench {
namespace {

using test::Engine;
using test::WorldFeatures;

// what counts as the proven distance
constexpr double exact = 1e-12;
constexpr int poses_in_path = 256;
constexpr std::uint64_t paths_of_costs = 6, paths_of_answers = 16;

struct Body {
  ShapePtr shape;
  VoronoiSolid solid;

  explicit Body(ShapePtr s) : shape(std::move(s)), solid(*part().core) {}
  const ConvexPart& part() const { return shape->parts()[0]; }
  Frame placed(const Frame& frame) const { return frame * part().placement(); }
  double outside(const Frame& frame, const Vec3& point) const {
    int face = 0;
    return part().core->face_separation(placed(frame).to_local(point), face);
  }
};

struct Pair {
  std::string name;
  Body a, b;

  double size() const { return 2 * std::max(a.part().bound_radius, b.part().bound_radius); }
};

std::vector<Pair> all_pairs() {
  Engine random(1998);
  const auto rock = [&random](int points) {
    return test::random_rock(random, points, {0.5, 0.5, 0.5});
  };
  std::vector<Pair> pairs;
  const auto add = [&pairs](const char* name, const ShapePtr& a, const ShapePtr& b) {
    pairs.push_back({name, Body(a), Body(b)});
  };
  add("boxes", make_box({1, 0.8, 0.6}), make_box({0.7, 1, 0.5}));
  add("hulls-8", rock(8), rock(8));
  add("hulls-12", rock(12), rock(12));
  add("hulls-32", rock(32), rock(32));
  add("hulls-100", rock(100), rock(100));
  add("hulls-500", rock(500), rock(500));
  add("plate-hull", make_box({1, 1, 0.001}), rock(12));
  add("needle-hull", make_box({0.001, 0.001, 1}), rock(12));
  add("plate-needle", make_box({1, 1, 0.001}), make_box({0.001, 0.001, 1}));
  return pairs;
}

const Frame& frame_of_a() {
  static const Frame frame(Pose{{0.3, -0.2, 0.1}, rotation_by({0.5, -0.7, 0.3})});
  return frame;
}

// Moves b along the normal until it is `gap` from a.
Frame at_gap(const Pair& pair, Frame frame, double gap) {
  const Separation s = part_separation(pair.a.part(), frame_of_a(), pair.b.part(), frame, nullptr);
  frame.p -= (s.distance - gap) * s.normal;
  return frame;
}

// A smooth tumble of so many degrees a pose at one gap, and back: no pose is far from the next, the
// last from the first neither.  About random axes, from a random place.
std::vector<Frame> tumble(const Pair& pair, double degrees, double gap, std::uint64_t seed) {
  Engine random(seed);
  const double angle = degrees * pi / 180;
  const Vec3 axis = test::random_direction(random), start = test::random_direction(random);
  const Vec3 orbit = test::random_direction(random);
  const Quat attitude = test::random_rotation(random);
  std::vector<Frame> path;
  for (int i = 0; i < poses_in_path; ++i) {
    const double turned = angle * std::min(i, poses_in_path - i);
    const Vec3 towards = rotation_by(0.7 * turned * orbit) * start;
    const Pose pose{frame_of_a().p + 3 * pair.size() * towards,
                    rotation_by(turned * axis) * attitude};
    path.push_back(at_gap(pair, Frame(pose), gap));
  }
  return path;
}

FeaturePair first_features(const Pair& pair, const Frame& b_in_a) {
  const Polyhedron &a = pair.a.solid.core(), &b = pair.b.solid.core();
  const Vec3 across = b_in_a * b.center() - a.center();
  return {{FeatureKind::vertex, a.support(across, 0)},
          {FeatureKind::vertex, b.support(b_in_a.R.transpose() * -across, 0)}};
}

struct VClipQuery {
  VClipAnswer in_a;
  Separation world;
};

// What part_separation does, by V-Clip.
VClipQuery by_vclip(const Pair& pair, const Frame& frame_b, FeaturePair* features) {
  const Frame world_a = pair.a.placed(frame_of_a());
  const Frame b_in_a = seen_from(world_a, pair.b.placed(frame_b));
  FeaturePair cold;
  if (features == nullptr) cold = first_features(pair, b_in_a);
  VClipQuery query{
      vclip(pair.a.solid, pair.b.solid, b_in_a, features != nullptr ? *features : cold), {}};
  query.world.distance = query.in_a.distance;
  query.world.normal = world_a.R * query.in_a.normal;
  query.world.point_a = world_a * query.in_a.point_a;
  query.world.point_b = world_a * query.in_a.point_b;
  return query;
}

Separation by_kernel(const Pair& pair, const Frame& frame_b, SimplexCache* cache) {
  return part_separation(pair.a.part(), frame_of_a(), pair.b.part(), frame_b, cache);
}

// -- Cost -----------------------------------------------------------------------------------------

double ns_per_query(const std::vector<Frame>& path,
                    const std::function<void(const Frame&)>& query) {
  double best = 1e300;
  for (int run = 0; run < 7; ++run) {
    const double start = cpu_seconds();
    for (int lap = 0; lap < 4; ++lap)
      for (const Frame& frame : path) query(frame);
    best = std::min(best, cpu_seconds() - start);
  }
  return 1e9 * best / (4.0 * static_cast<double>(path.size()));
}

// Keeps what is computed for nobody.
double sink = 0;

struct Costs {
  double gjk = 0, vclip = 0, gjk_cold = 0, vclip_cold = 0, steps = 0, steps_cold = 0;
};

Costs costs(const Pair& pair, double degrees, double gap) {
  Costs out;
  std::vector<Frame> path;
  for (std::uint64_t seed = 0; seed < paths_of_costs; ++seed) {
    const std::vector<Frame> one = tumble(pair, degrees, gap, seed);
    path.insert(path.end(), one.begin(), one.end());
  }
  SimplexCache cache;
  FeaturePair features;
  const auto share = static_cast<double>(path.size());
  for (const Frame& frame : path) by_vclip(pair, frame, &features);
  for (const Frame& frame : path) {
    out.steps += by_vclip(pair, frame, &features).in_a.steps / share;
    out.steps_cold += by_vclip(pair, frame, nullptr).in_a.steps / share;
  }
  out.gjk = ns_per_query(
      path, [&](const Frame& frame) { sink += by_kernel(pair, frame, &cache).distance; });
  out.vclip = ns_per_query(
      path, [&](const Frame& frame) { sink += by_vclip(pair, frame, &features).world.distance; });
  out.gjk_cold = ns_per_query(
      path, [&](const Frame& frame) { sink += by_kernel(pair, frame, nullptr).distance; });
  out.vclip_cold = ns_per_query(
      path, [&](const Frame& frame) { sink += by_vclip(pair, frame, nullptr).world.distance; });
  return out;
}

void print_row(const Costs& c) {
  std::printf(" %.0f | %.0f | %.2f | %.1f | %.0f | %.0f | %.2f | %.1f |\n", c.gjk, c.vclip,
              c.vclip / c.gjk, c.steps, c.gjk_cold, c.vclip_cold, c.vclip_cold / c.gjk_cold,
              c.steps_cold);
  std::fflush(stdout);
}

void print_costs(const std::vector<Pair>& pairs) {
  const char* columns =
      "GJK, ns | V-Clip, ns | ratio | steps | cold: GJK, ns | V-Clip, ns | ratio | steps |\n";
  std::printf("| pair | degrees | %s", columns);
  std::printf("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  for (const Pair& pair : pairs)
    for (const double degrees : {0.1, 1.0, 10.0, 45.0}) {
      std::printf("| %s | %g |", pair.name.c_str(), degrees);
      print_row(costs(pair, degrees, 0.1 * pair.size()));
    }
  std::printf("\n| pair, 1 degree | gap | %s", columns);
  std::printf("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  for (const Pair& pair : pairs) {
    if (pair.name != "boxes" && pair.name != "hulls-32") continue;
    for (const double gap : {1e-12, 1e-6, 0.01, 1.0, 10.0, -1e-6, -1e-3, -0.1}) {
      std::printf("| %s | %g |", pair.name.c_str(), gap);
      print_row(costs(pair, 1, gap * pair.size()));
    }
  }
}

// -- Answers --------------------------------------------------------------------------------------

// The feature of a solid that holds these vertices, the least one; none where no face does.
Feature feature_of(const Polyhedron& core, std::vector<int> vertices) {
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  if (vertices.size() == 1) return {FeatureKind::vertex, vertices[0]};
  if (vertices.size() == 2)
    for (const Polyhedron::Link& link : core.links(vertices[0]))
      if (link.vertex == vertices[1]) return {FeatureKind::edge, link.edge};
  for (std::size_t f = 0; f < core.faces().size(); ++f) {
    const Polyhedron::Face& face = core.faces()[f];
    std::size_t found = 0;
    for (int i = 0; i < face.count; ++i)
      found += static_cast<std::size_t>(
          std::count(vertices.begin(), vertices.end(), core.corner(face.first + i)));
    if (found == vertices.size()) return {FeatureKind::face, static_cast<int>(f)};
  }
  return {};
}

// How far a point of the solid is from a feature of it; all in the solid's frame.
double off_feature(const Polyhedron& core, const Feature& feature, const Vec3& point) {
  switch (feature.kind) {
    case FeatureKind::vertex: return (point - core.vertex(feature.index)).norm();
    case FeatureKind::edge: {
      const Polyhedron::Edge& edge = core.edges()[static_cast<std::size_t>(feature.index)];
      return test::point_segment(point, core.vertex(edge.tail), core.vertex(edge.head));
    }
    case FeatureKind::face: {
      const Polyhedron::Face& face = core.face(feature.index);
      double beyond = std::abs(face.normal.dot(point) - face.offset);
      for (int i = face.first; i < face.first + face.count; ++i)
        beyond = std::max(beyond, core.side(i).offset - core.side(i).inward.dot(point));
      return beyond;
    }
    default: return 1e300;
  }
}

// The width of the slab square to n between the bodies.
double slab(const Pair& pair, const Frame& frame_b, const Vec3& n) {
  if (n.isZero(0)) return -1e300;
  const Frame a = pair.a.placed(frame_of_a()), b = pair.b.placed(frame_b);
  const Vec3 in_a = a.R.transpose() * n, in_b = b.R.transpose() * n;
  double top = -1e300, bottom = 1e300;
  for (const Vec3& v : pair.a.solid.core().vertices()) top = std::max(top, in_a.dot(v));
  for (const Vec3& v : pair.b.solid.core().vertices()) bottom = std::min(bottom, in_b.dot(v));
  return (bottom - top + n.dot(b.p - a.p)) / n.norm();
}

// How one method did over a class of poses.
struct Score {
  long right = 0, off = 0, false_overlap = 0, missed = 0, out_of_steps = 0, depths = 0;
  long features = 0, features_asked = 0;
  double worst = 0;  // error of a distance, share of the size
};

struct Class {
  long poses = 0, overlaps = 0, touching = 0, unproven = 0, agree = 0, both = 0;
  double endless = 0;  // the greatest distance at which a walk had no end, share of the size
  double turned = 0;   // rad, the greatest angle between the two methods' normals
  Score gjk, vclip;
};

// Fails the program: the reference itself would be in doubt.
[[noreturn]] void fail(const Pair& pair, const char* what, double ours, double theirs) {
  std::fprintf(stderr, "vclip-bench: %s: %s: the kernel says %.17g, all pairs of features %.17g\n",
               pair.name.c_str(), what, ours, theirs);
  std::exit(1);
}

void check_by_brute_force(const Pair& pair, const Frame& frame_b, double distance) {
  const WorldFeatures a(pair.a.part(), frame_of_a()), b(pair.b.part(), frame_b);
  const double brute = distance > 0 ? test::brute_distance(a, b) : test::brute_axis(a, b);
  if (std::abs(distance) > exact * pair.size() &&
      !(std::abs(brute - distance) <= exact * pair.size()))
    fail(pair, distance > 0 ? "distance" : "depth", distance, brute);
}

// Whether the two witnesses are points of the bodies; then how far they are apart.
double between_points(const Pair& pair, const Frame& frame_b, const Separation& s) {
  const double beyond =
      std::max(pair.a.outside(frame_of_a(), s.point_a), pair.b.outside(frame_b, s.point_b));
  return beyond <= exact * pair.size() ? (s.point_b - s.point_a).norm() : 1e300;
}

void score_distance(Score& score, double said, bool says_overlap, double truth, double size) {
  const bool touches = std::abs(truth) <= exact * size;
  if (truth < 0 && !touches) {
    if (says_overlap)
      ++score.right;
    else
      ++score.missed;
    if (says_overlap && std::abs(said - truth) <= exact * size) ++score.depths;
    return;
  }
  if (says_overlap && !touches) {
    ++score.false_overlap;
    return;
  }
  const double error = says_overlap && touches ? 0 : std::abs(said - truth) / size;
  score.worst = std::max(score.worst, error);
  if (error <= exact)
    ++score.right;
  else
    ++score.off;
}

// Whether the witnesses lie on the features.
bool on_features(const Pair& pair, const Frame& frame_b, const Separation& s,
                 const FeaturePair& f) {
  const Vec3 in_a = pair.a.placed(frame_of_a()).to_local(s.point_a);
  const Vec3 in_b = pair.b.placed(frame_b).to_local(s.point_b);
  return off_feature(pair.a.solid.core(), f.a, in_a) <= exact * pair.size() &&
         off_feature(pair.b.solid.core(), f.b, in_b) <= exact * pair.size();
}

FeaturePair features_of(const Pair& pair, const SimplexCache& cache) {
  std::vector<int> a, b;
  for (std::size_t i = 0; i < static_cast<std::size_t>(cache.count); ++i) {
    a.push_back(cache.vertex_a[i]);
    b.push_back(cache.vertex_b[i]);
  }
  if (a.empty()) return {{}, {}};
  return {feature_of(pair.a.solid.core(), a), feature_of(pair.b.solid.core(), b)};
}

// One pose; the caches are those of the class, or null: cold.
void judge(const Pair& pair, const Frame& frame_b, SimplexCache* cache, FeaturePair* features,
           Class& out) {
  const double size = pair.size();
  SimplexCache own;
  SimplexCache* simplex = cache != nullptr ? cache : &own;
  const Separation gjk = by_kernel(pair, frame_b, simplex);
  FeaturePair mine =
      first_features(pair, seen_from(pair.a.placed(frame_of_a()), pair.b.placed(frame_b)));
  FeaturePair* pair_of_features = features != nullptr ? features : &mine;
  const VClipQuery vclip = by_vclip(pair, frame_b, pair_of_features);
  const bool ended = vclip.in_a.end != VClipEnd::out_of_steps;
  const bool overlap = vclip.in_a.end == VClipEnd::overlap;

  // the proof: the widest slab and the nearest points that any of the two gave
  const double lower =
      std::max(slab(pair, frame_b, gjk.normal), slab(pair, frame_b, vclip.world.normal));
  double truth = lower;
  if (lower > exact * size) {
    truth = between_points(pair, frame_b, gjk);
    if (ended && !overlap) truth = std::min(truth, between_points(pair, frame_b, vclip.world));
    if (!(truth - lower <= exact * size)) ++out.unproven;
  }
  const bool few = pair.a.solid.core().edges().size() * pair.b.solid.core().edges().size() < 2000;
  if (few && out.poses % 64 == 0) check_by_brute_force(pair, frame_b, gjk.distance);

  ++out.poses;
  if (std::abs(truth) <= exact * size)
    ++out.touching;
  else if (truth < 0)
    ++out.overlaps;
  score_distance(out.gjk, gjk.distance, gjk.distance < 0, truth, size);
  if (ended)
    score_distance(out.vclip, vclip.in_a.distance, overlap, truth, size);
  else {
    ++out.vclip.out_of_steps;
    out.endless = std::max(out.endless, std::abs(truth) / size);
    // a walk without end is begun anew, as a user would
    if (features != nullptr) *features = FeaturePair();
  }
  if (ended && !overlap && !vclip.world.normal.isZero(0))
    out.turned = std::max(out.turned, gjk.normal.cross(vclip.world.normal).norm());
  if (!(truth > 1e-8 * size)) return;
  const FeaturePair named = features_of(pair, *simplex);
  ++out.gjk.features_asked;
  if (on_features(pair, frame_b, gjk, named)) ++out.gjk.features;
  if (!ended || overlap) return;
  ++out.vclip.features_asked;
  if (on_features(pair, frame_b, vclip.world, *pair_of_features)) ++out.vclip.features;
  ++out.both;
  if (named.a == pair_of_features->a && named.b == pair_of_features->b) ++out.agree;
}

void print_class(const std::string& name, const Class& c) {
  std::printf("| %s | %ld | %ld, %ld |", name.c_str(), c.poses, c.overlaps, c.touching);
  std::printf(" %ld, %.0e |", c.poses - c.gjk.right, c.gjk.worst);
  std::printf(" %ld, %.0e | %ld, %ld | %ld, %.0e |", c.vclip.off, c.vclip.worst,
              c.vclip.false_overlap, c.vclip.missed, c.vclip.out_of_steps, c.endless);
  std::printf(" %ld, %ld |", c.gjk.depths, c.vclip.depths);
  std::printf(" %ld, %ld, %ld of %ld |", c.gjk.features, c.vclip.features, c.agree, c.both);
  std::printf(" %.0e | %ld |\n", c.turned, c.unproven);
  std::fflush(stdout);
}

void print_tracked(const std::vector<Pair>& pairs) {
  for (const bool warm : {true, false}) {
    Class out;
    for (const Pair& pair : pairs)
      for (const double degrees : {0.1, 1.0, 10.0, 45.0})
        for (const double gap : {0.01, 0.1, 1.0, 10.0}) {
          for (std::uint64_t seed = 0; seed < paths_of_answers; ++seed) {
            SimplexCache cache;
            FeaturePair features;
            for (const Frame& frame : tumble(pair, degrees, gap * pair.size(), seed))
              judge(pair, frame, warm ? &cache : nullptr, warm ? &features : nullptr, out);
          }
        }
    print_class(warm ? "all pairs, tracked" : "all pairs, cold", out);
  }
}

// Near touch: the same path at a small gap or depth.
void print_near(const std::vector<Pair>& pairs) {
  for (const double gap : {1e-4, 1e-6, 1e-9, 1e-12, 0.0, -1e-9, -1e-6, -1e-3, -0.1}) {
    Class out;
    for (const Pair& pair : pairs) {
      const double thin = std::min(pair.a.shape->least_width(), pair.b.shape->least_width());
      const double wanted = gap < 0 ? std::max(gap, -0.1) * thin : gap * pair.size();
      for (const double degrees : {1.0, 10.0}) {
        for (std::uint64_t seed = 0; seed < paths_of_answers; ++seed) {
          SimplexCache cache;
          FeaturePair features;
          for (const Frame& frame : tumble(pair, degrees, wanted, seed))
            judge(pair, frame, &cache, &features, out);
        }
      }
    }
    char name[64];
    std::snprintf(name, sizeof name, gap < 0 ? "all pairs, depth %g" : "all pairs, gap %g",
                  std::abs(gap));
    print_class(name, out);
  }
}

// Boxes in special poses as seen from a.
struct Special {
  const char* name;
  Mat3 rotation;  // of b in a
  Vec3 along;     // direction in which b lies, in a
  Vec3 slide;     // in which it slides past a
};

void print_special() {
  const Pair pair{"boxes", Body(make_box({1, 0.8, 0.6})), Body(make_box({0.7, 1, 0.5}))};
  const auto turn = [](double angle, const Vec3& axis) {
    return rotation_by(angle * axis).toRotationMatrix();
  };
  const Vec3 x = Vec3::UnitX(), z = Vec3::UnitZ();
  const Mat3 on_edge = turn(0.25 * pi, x);
  const Mat3 on_vertex = turn(std::atan(std::sqrt(2.0)), Vec3(1, -1, 0).normalized());
  const std::vector<Special> specials = {
      {"faces parallel", Mat3::Identity(), z, Vec3(1, 0.3, 0)},
      {"faces parallel, turned", turn(0.3, z), z, Vec3(1, 0.3, 0)},
      {"faces parallel to 1e-9", turn(0.3, z) * turn(1e-9, x), z, Vec3(1, 0.3, 0)},
      {"edge on face", on_edge, z, Vec3(1, 0.3, 0)},
      {"vertex over face, past its edge", on_vertex, z, Vec3(1, 0.3, 0)},
      {"edges parallel", on_edge, Vec3(0, 0.6, 0.8), x},
      {"edge against edge, corner to corner", Mat3::Identity(), Vec3(0, 0.6, 0.8), x},
      {"corners opposite", Mat3::Identity(), Vec3(1, 0.8, 0.6).normalized(), Vec3(0.1, 0, 0)},
  };
  for (const Special& special : specials) {
    Class out;
    for (const double gap : {0.1, 1e-3, 1e-6, 1e-9, 1e-12, 1e-15, 0.0, -1e-9, -1e-6, -1e-3, -0.1}) {
      SimplexCache cache;
      FeaturePair features;
      for (int i = -40; i <= 40; ++i) {
        const Vec3 place = 3 * special.along + 0.025 * i * special.slide;
        const Frame frame(frame_of_a().R * special.rotation, frame_of_a() * place);
        // down along a's own direction, so that what is parallel stays so
        const Vec3 down = frame_of_a().R * special.along;
        const Separation far = by_kernel(pair, frame, nullptr);
        const double slope = far.normal.dot(down);
        if (!(slope > 0.1)) continue;  // they pass each other
        Frame low = frame;
        low.p -= (far.distance - gap) / slope * down;
        judge(pair, low, &cache, &features, out);
        judge(pair, low, nullptr, nullptr, out);
      }
    }
    print_class(special.name, out);
  }
}

void print_answers(const std::vector<Pair>& pairs) {
  std::printf(
      "\n| class | poses | overlap, touch | GJK wrong, worst | V-Clip wrong, worst | overlap "
      "false, missed | no end, up to | depths right: GJK, V-Clip | features: GJK, V-Clip, same | "
      "normals apart, rad | unproven |\n");
  std::printf("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  print_tracked(pairs);
  print_near(pairs);
  print_special();
}

// Queries alone, for callgrind; `poses` does all but the queries.
int run_one(const std::vector<Pair>& pairs, const std::string& name, double degrees,
            const std::string& method, long queries) {
  const std::string methods[] = {"gjk", "vclip", "cold-gjk", "cold-vclip", "poses"};
  if (std::find(std::begin(methods), std::end(methods), method) == std::end(methods)) {
    std::fprintf(stderr, "vclip-bench: no method '%s'\n", method.c_str());
    return 2;
  }
  for (const Pair& pair : pairs) {
    if (pair.name != name) continue;
    const std::vector<Frame> path = tumble(pair, degrees, 0.1 * pair.size(), 0);
    SimplexCache cache;
    FeaturePair features;
    for (long i = 0; i < queries; ++i) {
      const Frame& frame = path[static_cast<std::size_t>(i) % path.size()];
      if (method == "cold-gjk") sink += by_kernel(pair, frame, nullptr).distance;
      if (method == "cold-vclip") sink += by_vclip(pair, frame, nullptr).world.distance;
      if (method == "gjk") sink += by_kernel(pair, frame, &cache).distance;
      if (method == "vclip") sink += by_vclip(pair, frame, &features).world.distance;
    }
    return 0;
  }
  std::fprintf(stderr, "vclip-bench: no pair '%s'\n", name.c_str());
  return 2;
}

}  // namespace
}  // namespace tw::bench

int main(int count, char** arguments) {
  using namespace tw::bench;
  const std::vector<Pair> pairs = all_pairs();
  if (count == 5)
    return run_one(pairs, arguments[1], std::atof(arguments[2]), arguments[3],
                   std::atol(arguments[4]));
  if (count != 1) {
    std::fprintf(stderr, "vclip-bench: expected nothing, or PAIR DEGREES METHOD QUERIES\n");
    return 2;
  }
  print_costs(pairs);
  print_answers(pairs);
  return 0;
}
