// Forward dynamics by MuJoCo: the stages of mj_forward that a tree without contacts needs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <iomanip>
#include <sstream>

#include "bench/mujoco-text.h"
#include "support/dynamics-engine.h"

namespace tw::test {
namespace {

// A body with all that hangs on it.
void write_body(std::ostream& out, const Links& links, const multibody::LinkSpec& link) {
  const Vec3 &p = link.joint.placement.p, &c = link.center_of_mass, &a = link.joint.axis;
  const Mat3& I = link.inertia;
  out << "<body pos='" << p.transpose() << "'>";
  out << "<inertial mass='" << link.mass << "' pos='" << c.transpose() << "' fullinertia='"
      << I(0, 0) << ' ' << I(1, 1) << ' ' << I(2, 2) << ' ' << I(0, 1) << ' ' << I(0, 2) << ' '
      << I(1, 2) << "'/>";
  if (link.joint.kind == multibody::JointKind::free)
    out << "<freejoint/>";
  else
    out << "<joint type='hinge' axis='" << a.transpose() << "'/>";
  for (const multibody::LinkSpec& child : links)
    if (child.parent == link.name) write_body(out, links, child);
  out << "</body>";
}

class MujocoEngine : public DynamicsEngine {
 public:
  MujocoEngine(const Links& links, const Vec3& gravity) {
    std::ostringstream out;
    out << std::setprecision(17);
    out << "<mujoco><compiler boundmass='0' boundinertia='0' balanceinertia='false'/>"
        << "<option gravity='" << gravity.transpose() << "'/><worldbody>";
    write_body(out, links, links[0]);
    out << "</worldbody></mujoco>";
    made_ = std::make_unique<bench::MujocoModel>(out.str());
    model_ = made_->model;
    data_ = made_->data;
  }

  void accelerations(const double* q, const double* u, const double* tau, double* rate) override {
    const auto nv = static_cast<std::size_t>(model_->nv);
    std::copy(q, q + model_->nq, data_->qpos);
    std::copy(u, u + nv, data_->qvel);
    mj_kinematics(model_, data_);
    mj_comPos(model_, data_);
    mj_crb(model_, data_);
    mj_factorM(model_, data_);
    mj_comVel(model_, data_);
    mj_rne(model_, data_, 0, data_->qfrc_bias);
    for (std::size_t i = 0; i < nv; ++i) data_->qfrc_smooth[i] = tau[i] - data_->qfrc_bias[i];
    mj_solveM(model_, data_, rate, data_->qfrc_smooth, 1);
  }

 private:
  std::unique_ptr<bench::MujocoModel> made_;
  mjModel* model_ = nullptr;
  mjData* data_ = nullptr;
};

}  // namespace

std::unique_ptr<DynamicsEngine> make_mujoco(const Links& links, const Vec3& gravity) {
  return std::make_unique<MujocoEngine>(links, gravity);
}

}  // namespace tw::test
