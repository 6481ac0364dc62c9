// The table of kinds.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "fuzz/generator.h"

#include <sys/mman.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>

#include "base/error.h"
#include "fuzz/apart.h"
#include "fuzz/draft.h"
#include "fuzz/kinds.h"
#include "fuzz/overlap.h"

namespace tw::fuzz {
namespace {

constexpr Kind table[] = {
    {"heap", "boxes, balls, cylinders, hulls, rocks and unions fall into a pit", draw_heap},
    {"lattice", "equal bodies in exact touch, in rows and grids, at rest or hit by one",
     draw_lattice},
    {"stack", "stacks of unlike masses, up to a million to one", draw_stack},
    {"thin", "rods, plates and coins of 1:100 to 1:1000 fall into a pit", draw_thin},
    {"piston", "a lid comes down on bodies in a pit and goes up again", draw_piston},
    {"drum", "bodies in a turning drum of staves", draw_drum},
    {"shaker", "bodies in a closed room that is shaken, turned and swung", draw_shaker},
    {"bullet", "bodies at 3 to 300 sqrt(g size) in a room with walls of 1 to 3 % of its width",
     draw_bullet},
    {"spin", "bodies that spin at 1 to 100 sqrt(g/size) fall into a pit", draw_spin},
    {"seam", "bodies slide, roll and fall on abutting tiles", draw_seam},
    {"groove", "bodies and spikes fall into a groove whose bottom edge is a seam", draw_groove},
    {"arch", "an arch is hit by a block", draw_arch},
    {"cards", "a card house is hit by a block", draw_cards},
    {"ramp", "bodies slide and roll down a ramp, along the floor, against a wall", draw_ramp},
    {"round", "capsules, cones, ellipsoids and cylinders among others fall into a pit", draw_round},
    {"hills", "bodies fall and roll on a height field between four walls", draw_hills},
    {"rolls", "what is round falls into a pit, where rolling and spinning are resisted",
     draw_rolls},
    {"plates", "tips and others fall into a trough of plates that meet at their inner edges alone",
     draw_plates},
    {"chains", "chains, stars and carts of links, hung or free, fall into a pit with others",
     draw_chains},
    {"bonds", "bodies that springs and holds tie to each other and to posts fall into a pit",
     draw_bonds},
    {"called", "bodies and carts that callbacks and sensors turn, hold and drive", draw_called},
    {"sensed", "as bonds; callbacks push against what springs, holds and accelerometers feel",
     draw_sensed},
    {"asked",
     "bodies, meshes among them, with drag and beside swinging ones; callbacks ask for rays, "
     "closest points, overlaps and boxes",
     draw_asked},
    {"driven",
     "bonds and chains with servos, forces by procedures and drag; callbacks push against "
     "what gyroscopes, contacts, holds and joints feel",
     draw_driven},
    {"tools", "what hangs on links without a shape is dragged over flat bodies", draw_tools},
    {"corner", "bodies slide into the corner of three walls that meet in edges or run on",
     draw_corner},
    {"flush", "unions of round parts that meet flush fall on a fixed one in a pit", draw_flush},
    {"struck", "columns on the ground, held and loaded, and chains are struck by what is thrown",
     draw_struck},
    {"pressed", "a spring presses a column onto the ground with 2 to some million weights",
     draw_pressed},
    {"rested", "begins with the poses of a heap that fell into a pit, to six digits", draw_rested,
     true},
    {"meshes", "as hills, on a mesh", draw_meshes},
};

// Which the seeds take in turn; the others are asked for by name, so that what is known of a seed
// stays its own.
constexpr std::size_t in_turn = 15;

// A body as it begins.
struct Placed {
  std::vector<Part> parts;
  Frame frame;

  explicit Placed(const DescribedBody& body) : parts(parts_of(body)), frame(body.pose) {
    if (body.keyframes.empty()) return;
    const Keyframe& first = body.keyframes.front();
    frame = Frame({first.position, first.orientation.value_or(Quat::Identity())});
  }
};

// `touch`: of the lesser width.
bool overlap_deep(const Placed& x, const Placed& y, double touch) {
  const double allowed = touch * std::min(least_width(x.parts), least_width(y.parts));
  return std::any_of(x.parts.begin(), x.parts.end(), [&](const Part& a) {
    return std::any_of(y.parts.begin(), y.parts.end(), [&](const Part& b) {
      return overlap(a, x.frame, b, y.frame, allowed) > allowed;
    });
  });
}

// A body and, of a multibody, the links that follow it.
std::size_t end_of(const std::vector<DescribedBody>& bodies, std::size_t first) {
  std::size_t end = first + 1;
  if (!bodies[first].hanging) return end;
  const std::string& multibody = bodies[first].hanging->multibody;
  while (end < bodies.size() && bodies[end].hanging && bodies[end].hanging->multibody == multibody)
    ++end;
  return end;
}

// Kinds place their bodies by their sizes, roughly: what overlaps one before it is left out, with
// its multibody, its bonds and its callbacks.
void leave_out_overlapping(DescribedScene& scene) {
  std::vector<DescribedBody> kept;
  std::vector<Placed> there;
  for (std::size_t i = 0, end; i < scene.bodies.size(); i = end) {
    end = end_of(scene.bodies, i);
    const std::size_t before = kept.size();
    bool blocked = false;
    for (std::size_t k = i; k < end; ++k) {
      const DescribedBody& body = scene.bodies[k];
      // links are not let go where they were put, and may not overlap at all
      const double touch = body.hanging ? 1e-7 : 1e-3;
      Placed fresh(body);
      for (std::size_t j = 0; j < kept.size() && body.dynamic(); ++j)
        blocked = blocked || (!body.joined_to(kept[j]) && overlap_deep(there[j], fresh, touch));
      kept.push_back(body);
      there.push_back(std::move(fresh));
    }
    if (!blocked) continue;
    kept.resize(before);
    there.erase(there.begin() + static_cast<std::ptrdiff_t>(before), there.end());
  }
  scene.bodies = std::move(kept);
  std::erase_if(scene.bonds, [&](const DescribedBond& bond) {
    return !scene.has(bond.a) || !scene.has(bond.b);
  });
  std::erase_if(scene.forces, [&](const DescribedForce& force) { return !scene.has(force.body); });
  std::erase_if(scene.servos, [&](const DescribedServo& servo) { return !scene.has(servo.link); });
  std::erase_if(scene.callbacks, [&](const DescribedCallback& callback) {
    return !std::all_of(callback.targets.begin(), callback.targets.end(),
                        [&](const std::string& name) { return scene.has(name); });
  });
}

// Poses as a file of six decimals would hand them on, at rest.  Where the run that they are from
// does not come to its end the scene begins as it was drawn, and its judge meets what ended that.
void settle(DescribedScene& scene) {
  const std::size_t bytes = scene.bodies.size() * sizeof(BodyState);
  void* const memory =
      mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::runtime_error("no memory to share");
  auto* const states = static_cast<BodyState*>(memory);
  constexpr double budget = 30;  // s of CPU
  const Findings findings = run_apart(budget, [&](Findings& f) {
    World world;
    world.set_threads(1);
    fill(world, scene);
    world.advance(scene.duration);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      new (states + i) BodyState(world.state(static_cast<BodyId>(i)));
    f.finished = true;
  });
  const double unit = 1e-6 * scene.size;
  const auto rounded = [](double x, double to) { return to * std::round(x / to); };
  for (std::size_t i = 0; i < scene.bodies.size() && findings.finished; ++i) {
    DescribedBody& body = scene.bodies[i];
    if (!body.dynamic()) continue;
    const BodyState& state = states[i];
    for (int k = 0; k < 3; ++k) body.pose.p[k] = rounded(state.position[k], unit);
    for (int k = 0; k < 4; ++k)
      body.pose.q.coeffs()[k] = rounded(state.orientation.coeffs()[k], 1e-6);
    body.pose.q.normalize();
    body.velocity = body.spin = Vec3::Zero();
  }
  munmap(memory, bytes);
}

}  // namespace

std::span<const Kind> kinds() { return table; }

DescribedScene random_scene(const std::string& kind, std::uint64_t seed) {
  for (const Kind& k : table)
    if (kind == k.name) {
      Draft draft(kind, seed);
      k.draw(draft);
      leave_out_overlapping(draft.scene);
      if (k.settles) settle(draft.scene);
      return draft.scene;
    }
  throw UserError("kind is " + kind + "; expected one that --help lists");
}

std::string kind_of_seed(std::uint64_t seed) { return table[seed % in_turn].name; }

}  // namespace tw::fuzz
