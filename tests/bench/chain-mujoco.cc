// The chain of chain-bench in MuJoCo.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "bench/chain-mujoco.h"

#include <cmath>
#include <iomanip>
#include <sstream>

#include "bench/mujoco-text.h"

namespace tw::bench {

std::optional<Vec3> run_mujoco_chain(int links, double step, double duration) {
  std::ostringstream out;
  out << std::setprecision(17) << "<mujoco><compiler boundmass='0' boundinertia='0'/>"
      << "<option gravity='0 0 -9.81' integrator='RK4' timestep='" << step << "'/><worldbody>";
  for (int i = 0; i < links; ++i)
    out << "<body pos='" << (i > 0 ? rod_length : 0) << " 0 0'><inertial mass='" << rod_mass
        << "' pos='" << 0.5 * rod_length << " 0 0' diaginertia='" << rod_inertia().transpose()
        << "'/><joint type='hinge' axis='0 1 0'/>";
  out << "<site name='tip' pos='" << rod_length << " 0 0'/>";
  for (int i = 0; i < links; ++i) out << "</body>";
  out << "</worldbody></mujoco>";
  const MujocoModel mujoco(out.str());
  const long steps = std::lround(duration / step);
  for (long i = 0; i < steps; ++i) mj_step(mujoco.model, mujoco.data);
  mj_kinematics(mujoco.model, mujoco.data);
  const double* tip = mujoco.data->site_xpos;
  return Vec3(tip[0], tip[1], tip[2]);
}

}  // namespace tw::bench
