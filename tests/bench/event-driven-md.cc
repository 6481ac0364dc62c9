// The dedicated event-driven program for a gas.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "event-driven-md.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.h"

namespace tw::bench {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

// Cell edge as a multiple of the mean spacing (volume / count)^(1/3): the fastest of 0.4 to 1.3.
constexpr double cell_per_spacing = 0.6;

}  // namespace

// ---- the initial state ----

Gas make_gas(int count) {
  Gas gas;
  gas.radius = 0.25;
  gas.side = std::cbrt(5.0 * count);
  Random random(static_cast<std::uint64_t>(count));
  const auto vector = [&](double from, double to) {
    const double x = random.real(from, to), y = random.real(from, to), z = random.real(from, to);
    return Vec3(x, y, z);
  };
  const auto is_free = [&](const Vec3& x) {
    return std::none_of(gas.position.begin(), gas.position.end(), [&](const Vec3& other) {
      return (x - other).squaredNorm() < 4.01 * gas.radius * gas.radius;
    });
  };
  while (static_cast<int>(gas.position.size()) < count) {
    const Vec3 x = vector(1.01 * gas.radius, gas.side - 1.01 * gas.radius);
    if (is_free(x)) gas.position.push_back(x);
  }
  // the sum of three numbers uniform in [-1, 1] has variance 1; a component's is 3^2 / 3
  for (int i = 0; i < count; ++i) {
    const Vec3 a = vector(-1, 1), b = vector(-1, 1), c = vector(-1, 1);
    gas.velocity.push_back(std::sqrt(3.0) * (a + b + c));
  }
  return gas;
}

EventDrivenMd::EventDrivenMd(const Gas& gas) : side_(gas.side), radius_(gas.radius) {
  const std::size_t count = gas.position.size();
  const double spacing = side_ / std::cbrt(static_cast<double>(count));
  cells_ =
      std::max(1, static_cast<int>(side_ / std::max(2.0 * radius_, cell_per_spacing * spacing)));
  edge_ = side_ / cells_;
  lists_.assign(static_cast<std::size_t>(cells_ * cells_ * cells_), nobody);

  spheres_.resize(count);
  place_.resize(count);
  const std::int32_t last = static_cast<std::int32_t>(count);
  for (std::int32_t i = 0; i < last; ++i) {
    const std::size_t at = static_cast<std::size_t>(i);
    Sphere& s = spheres_[at];
    s.x = gas.position[at];
    s.v = gas.velocity[at];
    for (int axis = 0; axis < 3; ++axis)
      s.cell[static_cast<std::size_t>(axis)] =
          static_cast<std::int16_t>(std::clamp(static_cast<int>(s.x[axis] / edge_), 0, cells_ - 1));
    s.impact = s.crossing = never;
    enter_cell(i);
    heap_.push_back({never, i});
    place_[at] = static_cast<std::uint32_t>(i);
  }
  for (std::int32_t i = 0; i < last; ++i) {
    find_crossing(sphere(i));
    look_anew(i, 0);
  }
}

// ---- cells ----

std::int32_t& EventDrivenMd::list_of(int x, int y, int z) {
  return lists_[static_cast<std::size_t>((x * cells_ + y) * cells_ + z)];
}

void EventDrivenMd::enter_cell(std::int32_t i) {
  Sphere& s = sphere(i);
  std::int32_t& first = list_of(s.cell[0], s.cell[1], s.cell[2]);
  s.next = first;
  s.previous = nobody;
  if (first != nobody) sphere(first).previous = i;
  first = i;
}

void EventDrivenMd::leave_cell(std::int32_t i) {
  const Sphere& s = sphere(i);
  std::int32_t& link =
      s.previous != nobody ? sphere(s.previous).next : list_of(s.cell[0], s.cell[1], s.cell[2]);
  link = s.next;
  if (s.next != nobody) sphere(s.next).previous = s.previous;
}

// When and where the centre leaves its cell: never through the cube's own walls.
void EventDrivenMd::find_crossing(Sphere& s) {
  s.crossing = never;
  for (int axis = 0; axis < 3; ++axis) {
    const int cell = s.cell[static_cast<std::size_t>(axis)];
    const int step = s.v[axis] > 0 ? 1 : -1;
    if (s.v[axis] == 0 || cell + step < 0 || cell + step >= cells_) continue;
    const double face = (step > 0 ? cell + 1 : cell) * edge_;
    const double when = s.since + (face - s.x[axis]) / s.v[axis];
    if (when >= s.crossing) continue;
    s.crossing = when;
    s.crossing_axis = static_cast<std::int8_t>(axis);
    s.crossing_step = static_cast<std::int8_t>(step);
  }
}

void EventDrivenMd::cross(std::int32_t i) {
  Sphere& s = sphere(i);
  const double when = s.crossing;
  const std::size_t axis = static_cast<std::size_t>(s.crossing_axis);
  const int step = s.crossing_step;
  leave_cell(i);
  s.cell[axis] = static_cast<std::int16_t>(s.cell[axis] + step);
  enter_cell(i);
  find_crossing(s);

  // the layer of nine cells that came into reach
  Range range = reach(s);
  range.lo[axis] = range.hi[axis] = s.cell[axis] + step;
  if (range.lo[axis] >= 0 && range.hi[axis] < cells_) look_in(i, range, when);
  schedule(i);
}

// ---- finding impacts ----

// Takes the first wall it will reach as its next impact.
void EventDrivenMd::find_wall(Sphere& s, double now) {
  s.impact = never;
  s.partner = nobody;
  for (int axis = 0; axis < 3; ++axis) {
    if (s.v[axis] == 0) continue;
    const double goal = s.v[axis] > 0 ? side_ - radius_ : radius_;
    const double when = std::max(now, s.since + (goal - s.x[axis]) / s.v[axis]);
    if (when >= s.impact) continue;
    s.impact = when;
    s.partner = wall - axis;
  }
}

// Frees the partner of an impact that will not be: it looks anew when the impact would have come.
void EventDrivenMd::part(std::int32_t i) {
  const std::int32_t partner = sphere(i).partner;
  if (partner >= 0) sphere(partner).partner = nobody;
}

void EventDrivenMd::meet(std::int32_t i, std::int32_t j, double when) {
  part(i);
  part(j);
  Sphere& a = sphere(i);
  Sphere& b = sphere(j);
  a.impact = b.impact = when;
  a.partner = j;
  b.partner = i;
  schedule(j);
}

// Impacts with the spheres of one cell that come before what either has in view.
void EventDrivenMd::look_in_cell(std::int32_t i, int x, int y, int z, double now) {
  const Sphere& a = sphere(i);
  for (std::int32_t j = list_of(x, y, z); j != nobody; j = sphere(j).next) {
    if (j == i) continue;
    const Sphere& b = sphere(j);
    // |r + u s|^2 = (2 radius)^2 from the later start, the smaller root without cancellation
    const double start = std::max(a.since, b.since);
    const Vec3 u = b.v - a.v;
    const Vec3 r = (b.x + (start - b.since) * b.v) - (a.x + (start - a.since) * a.v);
    const double half = r.dot(u);
    if (half >= 0) continue;
    const double gap = r.squaredNorm() - 4 * radius_ * radius_;
    const double discriminant = half * half - u.squaredNorm() * gap;
    if (discriminant <= 0) continue;
    const double when =
        std::max(now, start + std::max(0.0, gap) / (std::sqrt(discriminant) - half));
    if (when < a.impact && when < b.impact) meet(i, j, when);
  }
}

// The cells about the sphere's own, without what lies outside of the cube.
EventDrivenMd::Range EventDrivenMd::reach(const Sphere& s) const {
  Range range;
  for (std::size_t k = 0; k < 3; ++k) {
    range.lo[k] = std::max(0, s.cell[k] - 1);
    range.hi[k] = std::min(cells_ - 1, s.cell[k] + 1);
  }
  return range;
}

void EventDrivenMd::look_in(std::int32_t i, const Range& range, double now) {
  for (int x = range.lo[0]; x <= range.hi[0]; ++x)
    for (int y = range.lo[1]; y <= range.hi[1]; ++y)
      for (int z = range.lo[2]; z <= range.hi[2]; ++z) look_in_cell(i, x, y, z, now);
}

void EventDrivenMd::look_anew(std::int32_t i, double now) {
  part(i);
  find_wall(sphere(i), now);
  look_in(i, reach(sphere(i)), now);
  schedule(i);
}

// ---- impacts ----

void EventDrivenMd::move_to(Sphere& s, double when) {
  s.x += (when - s.since) * s.v;
  s.since = when;
}

void EventDrivenMd::bounce(std::int32_t i) {
  Sphere& s = sphere(i);
  const int axis = wall - s.partner;
  move_to(s, s.impact);
  s.v[axis] = -s.v[axis];
  ++wall_collisions_;
  find_crossing(s);
  look_anew(i, s.since);
}

void EventDrivenMd::collide(std::int32_t i) {
  Sphere& a = sphere(i);
  const std::int32_t j = a.partner;
  Sphere& b = sphere(j);
  move_to(a, a.impact);
  move_to(b, b.impact);
  // equal masses: the velocities along the line of centres are exchanged
  const Vec3 normal = (b.x - a.x).normalized();
  const Vec3 exchanged = (b.v - a.v).dot(normal) * normal;
  a.v += exchanged;
  b.v -= exchanged;
  ++pair_collisions_;
  find_crossing(a);
  find_crossing(b);
  a.partner = b.partner = nobody;
  look_anew(i, a.since);
  look_anew(j, b.since);
}

void EventDrivenMd::advance(double until) {
  while (heap_[0].time <= until) {
    const std::int32_t i = heap_[0].sphere;
    const Sphere& s = sphere(i);
    if (s.crossing < s.impact)
      cross(i);
    else if (s.partner >= 0)
      collide(i);
    else if (s.partner <= wall)
      bounce(i);
    else
      look_anew(i, s.impact);
  }
  now_ = until;
}

Vec3 EventDrivenMd::position(int i) const {
  const Sphere& s = spheres_[static_cast<std::size_t>(i)];
  return s.x + (now_ - s.since) * s.v;
}

// ---- the heap ----

void EventDrivenMd::put(std::size_t at, Slot slot) {
  heap_[at] = slot;
  place_[static_cast<std::size_t>(slot.sphere)] = static_cast<std::uint32_t>(at);
}

void EventDrivenMd::up(std::size_t at, Slot slot) {
  while (at > 0 && slot.time < heap_[(at - 1) / 4].time) {
    put(at, heap_[(at - 1) / 4]);
    at = (at - 1) / 4;
  }
  put(at, slot);
}

void EventDrivenMd::down(std::size_t at, Slot slot) {
  for (;;) {
    const std::size_t first = 4 * at + 1, end = std::min(first + 4, heap_.size());
    if (first >= end) break;
    std::size_t least = first;
    for (std::size_t c = first + 1; c < end; ++c)
      if (heap_[c].time < heap_[least].time) least = c;
    if (heap_[least].time >= slot.time) break;
    put(at, heap_[least]);
    at = least;
  }
  put(at, slot);
}

void EventDrivenMd::schedule(std::int32_t i) {
  const Sphere& s = sphere(i);
  const std::size_t at = place_[static_cast<std::size_t>(i)];
  const Slot slot{std::min(s.impact, s.crossing), i};
  if (slot.time < heap_[at].time)
    up(at, slot);
  else
    down(at, slot);
}

}  // namespace tw::bench
