// Explicit steps of bodies on springs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/explicit/spring-steps.h"

#include <algorithm>
#include <cmath>

#include "integrate/explicit/bond-equations.h"
#include "integrate/explicit/explicit-steps.h"
#include "integrate/explicit/step-polynomials.h"
#include "integrate/implicit/group-rows.h"
#include "math/rotation-vector.h"

namespace tw {

using namespace rows;

namespace {

class SpringSteps final : public StepMethod {
 public:
  // Where the scratch has the state at the last node.
  explicit SpringSteps(ArcWork& work) : work_(work), solution_(work, solution_of(work)) {}
  const char* step() override;
  bool is_done() const override { return done_; }

 private:
  static std::unique_ptr<Solution> solution_of(ArcWork& work);

  ArcWork& work_;
  ExplicitSolution solution_;
  bool done_ = false;
};

// Whether bodies on springs swing widely at the last node; their state there is in the scratch.
bool swings_here(ArcWork& work) {
  GroupScratch& s = work.system.scratch();
  const double time = work.reached();
  work.system.set_outside(time, s);
  work.record.load_last(work.system, s.state.data());
  work.system.linearise(time, s.state.data(), s, s.slope.data());
  work.counts.evaluations += 2;
  return swings_widely(work.start, work.system, s, time, s.state.data(), s.slope.data(),
                       s.trial.data());
}

std::unique_ptr<Solution> SpringSteps::solution_of(ArcWork& work) {
  const GroupStart& start = work.start;
  const double* at_start = work.system.scratch().state.data();
  std::vector<double> y(at_start, at_start + work.system.size()), chart(4 * start.members.size());
  for (std::size_t i = 0; i < start.members.size(); ++i)
    store(start.members[i].q, chart.data() + 4 * i);
  return std::make_unique<Solution>(dop853, std::make_unique<BondEquations>(start, work.system),
                                    start.time, std::move(y), std::move(chart));
}

// Cubics of the record follow a polynomial of higher degree in parts.  One with the values and
// rates of its ends errs by |y''''| l^4/384 over a length l: the number of parts by which that is
// within the tolerances, as fourth derivatives are at four places of the step.  `powers` as of
// DenseStep.
int parts_of(const GroupStart& start, const std::vector<double>& powers) {
  const std::size_t size = 12 * start.members.size();
  const std::size_t degree = powers.size() / size - 1;
  double worst = 0;
  for (const double r : {0.0, 1.0 / 3, 2.0 / 3, 1.0}) {
    const auto fourth = [&](std::size_t first) {
      Vec3 sum = Vec3::Zero();
      for (std::size_t k = degree; k >= 4; --k)
        sum = r * sum + static_cast<double>(k * (k - 1) * (k - 2) * (k - 3)) *
                            vec(powers.data() + size * k + first);
      return sum.norm();
    };
    for (std::size_t m = 0; m < start.members.size(); ++m) {
      const GroupMember& member = start.members[m];
      const std::size_t at = 12 * m;
      const double turning = member.radius / member.moments.minCoeff();
      worst = std::max({worst, fourth(at) / start.position_tolerance,
                        fourth(at + 3) * member.radius / start.position_tolerance,
                        fourth(at + 6) / start.velocity_tolerance,
                        fourth(at + 9) * turning / start.velocity_tolerance});
    }
  }
  const double parts = std::ceil(std::sqrt(std::sqrt(worst / 384)));
  return static_cast<int>(std::clamp(parts, 1.0, answer::most_parts));
}

// Of bodies on springs: one step.  The last one ends where the arc does: within a step polynomials
// err by more than at its end.
const char* SpringSteps::step() {
  GroupSystem& system = work_.system;
  GroupRecord& record = work_.record;
  const double from = record.reached();
  if (const char* failure = solution_.extend(from, work_.start.end)) return failure;
  const DenseStep& step = solution_.at(from);
  const double to = solution_.reached();
  const std::vector<double> powers = step.powers();
  const int parts = parts_of(work_.start, powers), size = 12 * system.members();
  StepPolynomials whole(from, size, step.degree());
  whole.append(to, powers);
  std::vector<double> y(index(size)), rates(index(size)), rates_before(index(size));
  whole.rates(0, 0, rates_before.data());
  GroupScratch& s = system.scratch();
  for (int i = 1; i <= parts; ++i) {
    const double t0 = record.reached(), t1 = i < parts ? from + (to - from) * i / parts : to;
    const double h = t1 - t0, r = i < parts ? whole.fraction(0, t1) : 1;
    whole.values(0, r, y.data());
    whole.rates(0, r, rates.data());
    record.load_last(system, s.state.data());
    double *y1 = s.trial.data(), *d3 = s.stage[4].data(), *d4 = s.stage[5].data();
    for (int m = 0; m < system.members(); ++m) {
      const int at = 12 * m;
      const Quat q = short_rotation(vec(y.data() + at + 3)) * quat(step.chart() + 4 * m);
      vec(y1 + at) = vec(y.data() + at);
      vec(y1 + at + 3) = turn_between(system.attitude(m), q);
      // (1-r) y0 + r (y1 + (1-r)(D3 + r D4)) with the rates of both ends
      for (const int row : {at + 6, at + 9}) {
        const Vec3 end = vec(y.data() + row), change = end - vec(s.state.data() + row);
        const Vec3 first = h * vec(rates_before.data() + row) - change;
        vec(y1 + row) = end;
        vec(d3 + row) = first;
        vec(d4 + row) = change - first - h * vec(rates.data() + row);
      }
    }
    record.append(t1, system, y1, d3, d4);
    std::swap(rates, rates_before);
  }
  work_.next_step = 0;
  done_ = solution_.is_time_to_choose() && !swings_here(work_);
  return nullptr;
}

}  // namespace

std::unique_ptr<StepMethod> spring_steps(ArcWork& work) {
  if (!is_tied_by_springs(work.start, work.system) || !swings_here(work)) return nullptr;
  return std::make_unique<SpringSteps>(work);
}

}  // namespace tw
