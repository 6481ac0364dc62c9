// Travels of bodies.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "detect/travels.h"

#include <atomic>
#include <bit>
#include <vector>

namespace tw {
namespace {

Travel travel_of(const Body& body, const Trajectory& trajectory, double from, double to) {
  Travel t;
  t.center = trajectory.center(from);
  if (body.fixed()) return t;
  const MotionBounds bounds = trajectory.bounds(from, to);
  const double length = to - from;
  t.turning = body.sphere_radius >= 0 ? 0 : bounds.turn * length * body.radius;
  if (bounds.velocity_may_jump() || bounds.valid_until < to) {
    t.off = {bounds.path.lo - t.center, bounds.path.hi - t.center};
    return t;
  }
  t.chord = trajectory.center(to) - t.center;
  const Aabb& pull = bounds.acceleration;
  const Vec3 most = (0.125 * length * length) * pull.lo.cwiseAbs().cwiseMax(pull.hi.cwiseAbs());
  t.off = {-most, most};
  return t;
}

std::uint64_t next_batch() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

}  // namespace

Travels::Travels() : batch_(next_batch()) {}

Travel Travels::of(const Body& body, const State& state, double from, double to) const {
  if (body.fixed()) return travel_of(body, state.trajectory(), from, to);
  struct Kept {
    std::uint64_t batch = 0;
    const State* state = nullptr;
    double from = 0, to = 0;
    Travel travel;
  };
  constexpr int bits = 11;
  thread_local std::vector<Kept> table(std::size_t{1} << bits);
  constexpr std::uint64_t odd = 0x9e3779b97f4a7c15u;  // 2^64 over the golden ratio
  const std::uint64_t mixed = (body.id() * odd ^ std::bit_cast<std::uint64_t>(from)) * odd ^
                              std::bit_cast<std::uint64_t>(to);
  Kept& kept = table[mixed * odd >> (64 - bits)];
  if (kept.batch != batch_ || kept.state != &state || kept.from != from || kept.to != to)
    kept = {batch_, &state, from, to, travel_of(body, state.trajectory(), from, to)};
  return kept.travel;
}

}  // namespace tw
