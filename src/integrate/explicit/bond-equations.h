// The equations of bodies that springs alone tie to each other, for explicit methods.
//
// y: 12 numbers a body, x, theta, v, L as in group-system.h; the chart is the attitudes, on which
// the rotation vectors theta count.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "integrate/arc/group-arc.h"
#include "integrate/explicit/equations.h"
#include "integrate/implicit/group-system.h"

namespace tw {

class BondEquations final : public Equations {
 public:
  // Both must outlive it; the system's attitudes are the chart of the last call.
  BondEquations(const GroupStart& start, GroupSystem& system) : start_(start), system_(system) {}

  int size() const override { return 12 * system_.members(); }
  int chart_size() const override { return 4 * system_.members(); }
  void slope(double time, const double* y, const double* chart, double* slope) const override;
  void tolerances(const double* y, const double* chart, double* allowed) const override;
  double longest_step(const double* y, const double* slope, const double* chart) const override;
  void recentre(double* y, double* slope, double* chart) const override;

 private:
  const GroupStart& start_;
  GroupSystem& system_;
};

// Whether the group is bodies and springs and nothing else, among what stands still.
bool is_tied_by_springs(const GroupStart& start, const GroupSystem& system);

// Whether such a group swings so widely on its springs, and they damp so little, that an explicit
// method takes longer steps than RODAS4.  `y`: a state at `time`, `slope` its rate there, both as
// linearised last; `other` is overwritten.
bool swings_widely(const GroupStart& start, const GroupSystem& system, GroupScratch& scratch,
                   double time, const double* y, const double* slope, double* other);

}  // namespace tw
