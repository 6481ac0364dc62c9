// Explicit steps of a multibody that touches nothing.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/explicit/tree-steps.h"

#include <algorithm>

#include "base/constants.h"
#include "integrate/explicit/explicit-steps.h"
#include "integrate/explicit/joint-equations.h"

namespace tw {
namespace {

class TreeSteps final : public StepMethod {
 public:
  // `nonstiff`: nothing at its joints is stiff, so it never is done.
  TreeSteps(ArcWork& work, bool nonstiff)
      : work_(work), nonstiff_(nonstiff), solution_(work, solution_of(work)) {}

  const char* step() override;
  int joint_degree() const override { return solution_.degree(); }
  bool is_done() const override { return done_; }

 private:
  static std::unique_ptr<Solution> solution_of(const ArcWork& work);

  ArcWork& work_;
  bool nonstiff_, done_ = false;
  ExplicitSolution solution_;
  std::vector<double> q_, u_;
};

std::unique_ptr<Solution> TreeSteps::solution_of(const ArcWork& work) {
  const GroupStart& start = work.start;
  const GroupTree& tree = start.trees.front();
  std::vector<double> y(tree.state->u.size(), 0.0);
  y.insert(y.end(), tree.state->u.begin(), tree.state->u.end());
  return std::make_unique<Solution>(
      start.joint_tolerance > answer::loose_steps ? tsit5 : dop853,
      std::make_unique<JointEquations>(tree, start.end, start.joint_tolerance, start.joint_size,
                                       start.joint_rate),
      start.time, std::move(y), tree.state->q);
}

// The last one as far as the end.
const char* TreeSteps::step() {
  const double from = work_.reached();
  if (const char* failure = solution_.extend(from)) return failure;
  const DenseStep& step = solution_.at(from);
  const double to = std::min(solution_.reached(), work_.start.end);
  const double share = (to - from) / (step.end() - step.start());
  TreeInGroup& tree = *work_.system.trees().front();
  const std::size_t n = static_cast<std::size_t>(tree.freedoms());
  std::vector<double> powers = step.powers();
  const std::size_t degree = powers.size() / (2 * n) - 1;
  std::vector<double> end(powers.begin(), powers.begin() + static_cast<std::ptrdiff_t>(n));
  double scale = 1;
  for (std::size_t k = 1; k <= degree; ++k) {
    scale *= share;
    for (std::size_t e = 0; e < 2 * n; ++e) powers[2 * n * k + e] *= scale;
    for (std::size_t e = 0; e < n; ++e) end[e] += powers[2 * n * k + e];
  }
  JointRecord& joints = work_.joints.front();
  joints.joints(from, q_, u_);
  tree.set_positions(q_);
  joints.append(to, powers, tree.displaced(end.data()));
  // no member moves by itself
  work_.record.append(to, work_.system, nullptr, nullptr, nullptr);
  work_.next_step = 0;
  if (!nonstiff_ && solution_.is_time_to_choose()) {
    joints.joints(to, q_, u_);
    done_ = !swings_widely(work_.start, to, q_, u_);
  }
  return nullptr;
}

}  // namespace

std::unique_ptr<StepMethod> tree_steps(ArcWork& work) {
  const GroupStart& start = work.start;
  const bool alone = start.joint_tolerance > 0 && start.trees.size() == 1 &&
                     start.contacts.empty() && start.bonds.empty() &&
                     std::none_of(start.members.begin(), start.members.end(),
                                  [](const GroupMember& m) { return m.forces != nullptr; }) &&
                     start.members.size() == start.trees.front().members.size();
  if (!alone) return nullptr;
  const GroupTree& tree = start.trees.front();
  const bool nonstiff = is_nonstiff(tree, start.joint_size, start.joint_rate);
  if (!nonstiff && !swings_widely(start, start.time, tree.state->q, tree.state->u)) return nullptr;
  return std::make_unique<TreeSteps>(work, nonstiff);
}

}  // namespace tw
