// The car of car-bench in MuJoCo.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cmath>
#include <iomanip>
#include <sstream>

#include "bench/car-model.h"
#include "bench/mujoco-text.h"

namespace tw::bench {
namespace {

void write_wheel(std::ostream& out, const CarModel& car, int number, const Vec3& place) {
  out << "<body pos='" << place.transpose() << "'><joint name='wheel-" << number
      << "' type='hinge' axis='0 1 0'/><geom type='" << (car.balls ? "sphere" : "cylinder")
      << "' size='" << car.radius << ' ' << 0.5 * car.width << "' euler='90 0 0' mass='"
      << car.wheel_mass << "' contype='1' conaffinity='0'/></body>";
}

}  // namespace

std::optional<Vec3> run_mujoco_car(const CarModel& car, double step, double duration) {
  std::ostringstream out;
  out << std::setprecision(17)
      << "<mujoco><option gravity='0 0 -9.81' cone='elliptic' tolerance='1e-14' iterations='200' "
         "timestep='"
      << step << "'/><default><geom friction='" << car.friction
      << " 0 0'/></default><worldbody><geom type='plane' size='0 0 1' contype='0' conaffinity='1'/>"
      << "<body pos='0 0 " << car.height() << "'><freejoint/><geom type='box' size='"
      << (0.5 * car.chassis).transpose() << "' mass='" << car.chassis_mass
      << "' contype='0' conaffinity='0'/>";
  for (int i = 0; i < 4; ++i) {
    const Vec3 place(i < 2 ? car.axle : -car.axle, i % 2 == 0 ? car.track : -car.track, -car.drop);
    if (i >= 2) {
      write_wheel(out, car, i, place);
      continue;
    }
    out << "<body pos='" << place.transpose() << "'><joint name='knuckle-" << i
        << "' type='hinge' axis='0 0 1' damping='" << car.steering_damping
        << "'/><geom type='box' size='" << (0.5 * car.knuckle).transpose() << "' mass='"
        << car.knuckle_mass << "' contype='0' conaffinity='0'/>";
    write_wheel(out, car, i, Vec3::Zero());
    out << "</body>";
  }
  out << "</body></worldbody><actuator>";
  for (int i = 0; i < 4; ++i)
    out << "<velocity joint='wheel-" << i << "' kv='" << car.drive << "'/>";
  for (int i = 0; i < 2; ++i)
    out << "<position joint='knuckle-" << i << "' kp='" << car.steering << "'/>";
  out << "</actuator></mujoco>";
  const MujocoModel mujoco(out.str());
  const long steps = std::lround(duration / step), ticks = std::lround(car.tick / step);
  for (long i = 0; i < steps; ++i) {
    if (i % ticks == 0) {
      const double time = step * static_cast<double>(i);
      for (int w = 0; w < 4; ++w) mujoco.data->ctrl[w] = car.wheel_speed(time);
      for (int k = 4; k < 6; ++k) mujoco.data->ctrl[k] = car.angle(time);
    }
    mj_step(mujoco.model, mujoco.data);
  }
  return Vec3(mujoco.data->qpos[0], mujoco.data->qpos[1], mujoco.data->qpos[2]);
}

}  // namespace tw::bench
