// The avalanche in MuJoCo: all bodies as convex meshes, each piece of ground a body of its own, so
// that its broad phase tells them apart.
//
// Settings: semi-implicit Euler, its default; conjugate gradients, for Newton's method takes five
// times as long once rocks pile up and is no shallower; elliptic cones; contacts are mended within
// two steps, the fastest that is stable.  It has no coefficient of restitution: rocks do not
// bounce.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <iomanip>
#include <sstream>

#include "mujoco-text.h"
#include "other-engine.h"

namespace tw::bench {
namespace {

std::ostream& operator<<(std::ostream& out, const Vec3& x) {
  return out << x.x() << ' ' << x.y() << ' ' << x.z();
}
std::ostream& operator<<(std::ostream& out, const Quat& q) {
  return out << q.w() << ' ' << q.x() << ' ' << q.y() << ' ' << q.z();
}

void write_mesh(std::ostream& out, std::size_t index, const Polyhedron& hull) {
  out << "<mesh name='" << index << "' vertex='";
  for (const Vec3& x : hull.vertices()) out << x << ' ';
  out << "'/>";
}

// Inertia about the centre of mass, which is the frame's origin.
void write_inertia(std::ostream& out, const OtherBody& body) {
  const Mat3& i = body.inertia;
  out << "<freejoint/><inertial pos='0 0 0' mass='" << body.mass << "' fullinertia='" << i(0, 0)
      << ' ' << i(1, 1) << ' ' << i(2, 2) << ' ' << i(0, 1) << ' ' << i(0, 2) << ' ' << i(1, 2)
      << "'/>";
}

std::string text(const OtherScene& scene, long rate) {
  std::ostringstream out;
  const double step = 1 / static_cast<double>(rate);
  out << std::setprecision(17)
      << "<mujoco><compiler boundmass='0' boundinertia='0' balanceinertia='false'/>"
         "<size njmax='8000' nconmax='2500' nstack='50000000'/><option gravity='"
      << scene.gravity << "' timestep='" << step
      << "' cone='elliptic' solver='CG'/><default><geom condim='3' "
      << "friction='" << scene.friction << " 0 0' solref='" << 2 * step << " 1'/></default><asset>";
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) write_mesh(out, i, scene.bodies[i].hull());
  out << "</asset><worldbody>";
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const OtherBody& body = scene.bodies[i];
    out << "<body pos='" << body.pose.p << "' quat='" << body.pose.q << "'>";
    if (!body.fixed) write_inertia(out, body);
    out << "<geom type='mesh' mesh='" << i << "'/></body>";
  }
  out << "</worldbody></mujoco>";
  return out.str();
}

class MujocoEngine : public OtherEngine {
 public:
  MujocoEngine(const OtherScene& scene, const OtherOptions& options)
      : made_(text(scene, options.rate)) {
    mju_user_warning = [](const char*) {};
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      if (!scene.bodies[i].fixed) set_velocity(i, scene.bodies[i]);
  }
  void step(double) override { mj_step(made_.model, made_.data); }
  OtherState state(std::size_t index) const override;

 private:
  mjtNum* velocity_of(std::size_t index) const {
    return made_.data->qvel + made_.model->body_dofadr[index + 1];
  }
  // A free joint has its angular velocity in the body's frame.
  void set_velocity(std::size_t index, const OtherBody& body) {
    const Vec3 w = body.pose.q.conjugate() * body.angular_velocity;
    mjtNum* qvel = velocity_of(index);
    for (int i = 0; i < 3; ++i) {
      qvel[i] = body.velocity[i];
      qvel[i + 3] = w[i];
    }
  }

  MujocoModel made_;
};

OtherState MujocoEngine::state(std::size_t index) const {
  // where it became unstable it has begun anew by itself; contacts that found no room are left out
  OtherState result;
  for (const int kind :
       {mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC, mjWARN_CONTACTFULL, mjWARN_CNSTRFULL})
    if (made_.data->warning[kind].number > 0) throw std::runtime_error("MuJoCo became unstable");
  const mjtNum* q =
      made_.data->qpos + made_.model->jnt_qposadr[made_.model->body_jntadr[index + 1]];
  const mjtNum* v = velocity_of(index);
  result.pose = {Vec3(q[0], q[1], q[2]), Quat(q[3], q[4], q[5], q[6]).normalized()};
  result.velocity = Vec3(v[0], v[1], v[2]);
  result.angular_velocity = result.pose.q * Vec3(v[3], v[4], v[5]);
  return result;
}

}  // namespace
}  // namespace tw::bench

int main(int argc, char** argv) {
  using namespace tw::bench;
  const auto make = [](const OtherScene& scene, const OtherOptions& options) {
    return std::make_unique<MujocoEngine>(scene, options);
  };
  return run_other_engine({std::string("MuJoCo ") + mj_versionString(), make}, argc, argv);
}
