// The cases in MuJoCo.
//
// It has no coefficient of restitution: what bounces gets a spring and a damper that give the
// coefficient in the limit of short steps.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

#include "bench/engine-cases.h"
#include "bench/made-cases.h"
#include "bench/mujoco-text.h"
#include "math/vec.h"
#include "support/case-motion.h"

namespace tw::bench {
namespace {

// s: contacts of what slides and rests are mended within this, at least; heaps' within two steps
constexpr double slowest = 2e-3;
// what bounces touches for ten steps at least and, as steps shrink, for sqrt(step * 0.1 s)
constexpr double bounce_steps = 10, bounce_length = 0.1;

template <std::size_t N>
std::string text_of(const std::array<double, N>& numbers) {
  std::ostringstream out;
  out << std::setprecision(17);
  for (const double x : numbers) out << x << ' ';
  return out.str();
}

// What a damped spring leaves of a speed, if it only pushes and lets go where its force vanishes;
// `damping` is a fraction of the critical one, below sqrt(1/2).
double restitution_of(double damping) {
  const double root = std::sqrt(1 - damping * damping);
  const double phase = pi - std::atan2(2 * damping * root, 1 - 2 * damping * damping);
  return std::exp(-damping / root * phase);
}

double damping_of(double restitution) {
  double low = 0, high = 0.7;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (restitution_of(middle) > restitution ? low : high) = middle;
  }
  return low;
}

class Mujoco : public CaseEngine {
 public:
  Mujoco(const CaseTable& c, double step) : made_(text(c, step)), case_(c), step_(step) {
    mju_user_warning = [](const char*) {};
    set_velocities(c);
    mj_kinematics(made_.model, made_.data);
  }
  void advance(double duration) override {
    for (long n = std::lround(duration / step_); n > 0; --n) {
      drive();
      mj_step(made_.model, made_.data);
    }
    mj_kinematics(made_.model, made_.data);
  }
  EngineState state(std::size_t body) const override;

 private:
  static std::string text(const CaseTable& c, double step);
  void set_velocities(const CaseTable& c);
  void drive();

  MujocoModel made_;
  CaseTable case_;
  double step_;
  long steps_ = 0;
};

// Of the reference acceleration of contacts, and how near to it they get.
std::string contact_text(const CaseTable& c, double step) {
  std::ostringstream out;
  out << std::setprecision(17);
  // in a heap what little bounces does not bounce
  if (c.restitution < 0.5) {
    const double mended = is_heap(c.name) ? 2 * step : std::max(2 * step, slowest);
    out << "solref='" << mended << " 1' solimp='0.99 0.99 0.001'";
  } else {
    const double length = std::max(bounce_steps * step, std::sqrt(bounce_length * step));
    const double rate = pi / length;
    out << "solref='" << -rate * rate << ' ' << -2 * damping_of(c.restitution) * rate
        << "' solimp='0.9999 0.9999 0.001'";
  }
  return out.str();
}

// The bodies that hang on a body, each with what hangs on it; `from` is where the body's own hinge
// is.  Bodies without a turn at the start; MuJoCo numbers them by depth, as the tables do chains.
void write_hinged(std::ostream& out, const CaseTable& c, int parent, const test::Numbers3& from) {
  for (const test::CaseHinge& hinge : c.hinges) {
    if (hinge.parent != parent) continue;
    const CaseBody& body = c.bodies[static_cast<std::size_t>(hinge.child)];
    test::Numbers3 place, center;
    mju_sub3(place.data(), hinge.anchor.data(), from.data());
    mju_sub3(center.data(), body.position.data(), hinge.anchor.data());
    out << "<body pos='" << text_of(place) << "'><joint type='hinge' axis='" << text_of(hinge.axis)
        << "'/><inertial pos='" << text_of(center) << "' mass='" << body.mass << "' diaginertia='"
        << text_of(body.inertia) << "'/>";
    write_hinged(out, c, hinge.child, hinge.anchor);
    out << "</body>";
  }
}

// Of a geom: shape and place.
std::string geom_text(const CaseBody& body) {
  return "<geom type='" + body.shape + "' size='" + text_of(body.size) + "' pos='" +
         text_of(body.position) + "' quat='" + text_of(body.orientation) + "'/>";
}

// Driven bodies as one, heavy enough for nothing to hold it up, on the joint that drive() sets.
std::string driven_text(const CaseTable& c) {
  const bool turns = c.motion.rate != 0;
  std::string out = "<body name='driven'><joint name='driven' armature='1e6' type='";
  out += turns ? "hinge" : "slide";
  out += "' axis='" + text_of(turns ? c.motion.axis : c.motion.swing) + "'/>";
  for (const CaseBody& body : c.bodies)
    if (body.driven) out += geom_text(body);
  return out + "</body>";
}

// By default there is room for a few hundred contacts.  More costs time to make, and in a large
// gas, in which few touch at once, more memory than there is.
std::string room_text(const CaseTable& c) {
  if (c.bodies.size() <= 40) return "";
  return c.bodies.size() > 1000 ? "<size njmax='1000' nconmax='1000'/>"
                                : "<size njmax='8000' nconmax='4000'/>";
}

// A heap is solved by conjugate gradients, as far as MuJoCo does by default: Newton's method takes
// 13 times as long in the shaken box and is no shallower.
std::string Mujoco::text(const CaseTable& c, double step) {
  std::ostringstream out;
  const bool contacts = c.bodies.size() > 1 && c.hinges.empty();
  out << std::setprecision(17)
      << "<mujoco><compiler boundmass='0' boundinertia='0' balanceinertia='false'/>" << room_text(c)
      << "<option gravity='" << text_of(c.gravity) << "' timestep='" << step << "' integrator='"
      << (contacts ? "Euler" : "RK4") << "' cone='"
      << (c.name == "stack" || c.name == "kapla" ? "pyramidal" : "elliptic")
      << (is_heap(c.name) ? "' solver='CG" : "' impratio='100' tolerance='1e-14")
      << "'/><default><geom condim='" << (c.friction > 0 ? 3 : 1) << "' friction='" << c.friction
      << " 0 0' " << contact_text(c, step) << "/></default><worldbody>";
  write_hinged(out, c, -1, {});
  for (const CaseBody& body : c.bodies) {
    if (!c.hinges.empty()) break;
    const std::string place =
        "pos='" + text_of(body.position) + "' quat='" + text_of(body.orientation) + "'";
    if (body.fixed) {
      // an empty body keeps the numbers; of a pair the friction with the higher priority counts
      out << "<body/><geom type='plane' size='0 0 1' " << place;
      if (body.friction >= 0) out << " priority='1' friction='" << body.friction << " 0 0'";
      out << "/>";
      continue;
    }
    if (body.driven) {
      out << "<body/>";
      continue;
    }
    out << "<body " << place << "><freejoint/><inertial pos='0 0 0' mass='" << body.mass
        << "' diaginertia='" << text_of(body.inertia) << "'/><geom type='" << body.shape
        << "' size='" << text_of(body.size) << "'/></body>";
  }
  if (c.bodies[0].driven) out << driven_text(c);
  out << "</worldbody></mujoco>";
  return out.str();
}

// A free joint has its angular velocity in the body's frame.
void Mujoco::set_velocities(const CaseTable& c) {
  const mjModel& model = *made_.model;
  for (std::size_t i = 0; i < c.bodies.size(); ++i) {
    const CaseBody& body = c.bodies[i];
    const int number = static_cast<int>(i) + 1;
    if (model.body_dofnum[number] != 6) continue;
    double* qvel = made_.data->qvel + model.body_dofadr[number];
    mju_copy3(qvel, body.velocity.data());
    double back[4];
    mju_negQuat(back, body.orientation.data());
    mju_rotVecQuat(qvel + 3, body.angular_velocity.data(), back);
  }
}

// The joint as it is to be at the step's start, and forces, which stay.
void Mujoco::drive() {
  const double now = static_cast<double>(steps_++) * step_;
  const mjModel& model = *made_.model;
  mjData& data = *made_.data;
  for (std::size_t i = 0; i < case_.bodies.size(); ++i)
    mju_copy3(data.xfrc_applied + 6 * (i + 1), case_.bodies[i].force.data());
  const int joint = mj_name2id(&model, mjOBJ_JOINT, "driven");
  if (joint < 0) return;
  const test::CasePlacement at = test::placement_at(case_.motion, now);
  const bool turns = case_.motion.rate != 0;
  data.qpos[model.jnt_qposadr[joint]] = turns ? at.angle : mju_norm3(at.shift.data());
  const double direction = mju_dot3(at.velocity.data(), case_.motion.swing.data());
  data.qvel[model.jnt_dofadr[joint]] =
      turns ? at.rate : std::copysign(mju_norm3(at.velocity.data()), direction);
}

EngineState Mujoco::state(std::size_t body) const {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const mjData& data = *made_.data;
  // where it became unstable it has begun anew by itself; contacts that found no room are left out
  for (const int kind :
       {mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC, mjWARN_CONTACTFULL, mjWARN_CNSTRFULL})
    if (data.warning[kind].number > 0) return {{nan, nan, nan}, {nan, nan, nan, nan}, {}, {}};
  const mjtNum *p = data.xipos + 3 * (body + 1), *q = data.xquat + 4 * (body + 1);
  EngineState result{{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}, {}, {}};
  const int number = static_cast<int>(body) + 1;
  if (made_.model->body_dofnum[number] == 6) {
    const mjtNum* qvel = data.qvel + made_.model->body_dofadr[number];
    mju_copy3(result.velocity.data(), qvel);
    mju_rotVecQuat(result.angular_velocity.data(), qvel + 3, q);
  }
  return result;
}

}  // namespace
}  // namespace tw::bench

int main(int argc, char** argv) {
  using namespace tw::bench;
  return run_cases(runner_of<Mujoco>("MuJoCo", mj_versionString()), argc, argv);
}
