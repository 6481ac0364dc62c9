// The chain of chain-bench in MuJoCo.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "bench/chain-mujoco.h"

#include <mujoco/mujoco.h>

#include <cmath>
#include <cstring>
#include <iomanip>
#include <memory>
#include <sstream>
#include <stdexcept>

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
  const std::string text = out.str();
  auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "chain.xml", static_cast<int>(text.size()));
  std::memcpy(files->filedata[0], text.data(), text.size());
  char error[1000] = "";
  mjModel* model = mj_loadXML("chain.xml", files.get(), error, sizeof error);
  mj_deleteVFS(files.get());
  if (!model) throw std::runtime_error(error);
  mjData* data = mj_makeData(model);
  const long steps = std::lround(duration / step);
  for (long i = 0; i < steps; ++i) mj_step(model, data);
  mj_kinematics(model, data);
  const Vec3 tip(data->site_xpos[0], data->site_xpos[1], data->site_xpos[2]);
  mj_deleteData(data);
  mj_deleteModel(model);
  return tip;
}

}  // namespace tw::bench
