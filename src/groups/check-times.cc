// When group checks happen.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/check-times.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"

namespace tw {
double check_interval(const Regrouping& work, const std::vector<ProcessId>& members) {
  const double gravity = work.scene().gravity_scale();
  double interval = never;
  for (const ProcessId member : members) {
    // the time to move that far: v s + g s^2/2 = distance
    const PlacedBody body = placed(*work.successor_of(member));
    const double distance = answer::most_travel * body.body->least_width;
    const double speed = body.surface_speed();
    const double root = std::sqrt(speed * speed + 2 * gravity * distance);
    interval = std::min(interval, 2 * distance / (speed + root));
  }
  // to a power of two on the grid
  const double rate = work.scene().options.group_check_rate;
  const double ticks = interval * rate;
  const int halvings = ticks > 1 ? std::min(answer::most_halvings, std::ilogb(ticks)) : 0;
  return std::ldexp(1 / rate, halvings);
}

double next_check_time(double birth, double now, double interval) {
  double k = std::max(0.0, std::floor((now - birth) / interval));
  while (birth + k * interval <= now) ++k;
  return birth + k * interval;
}

Key group_check_key(const Group& group, double when) {
  const bool starts_now = group.key.time == when;
  return {when, 1 + (starts_now ? group.key.microstep : 0), KeyKind::group_check, 0};
}

}  // namespace tw
