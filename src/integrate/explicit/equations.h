// Systems of ordinary differential equations that explicit Runge-Kutta methods integrate.
//
// y' = f(t, y), y a row of numbers.  What the numbers mean may hang on a *chart*, more numbers that
// stay as they are throughout a step: a body's attitude is kept as the rotation vector from the
// step's start, and the chart is the attitude there.  All of it is a function of the arguments
// alone: whoever asks, and in whatever order, gets the same bits.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace tw {

class Equations {
 public:
  virtual ~Equations() = default;

  // Of y, >= 1, and of a chart.
  virtual int size() const = 0;
  virtual int chart_size() const { return 0; }

  virtual void slope(double time, const double* y, const double* chart, double* slope) const = 0;

  // The error of a step that is allowed in each number of y, > 0: errors are measured in it, by
  // their root mean square.
  virtual void tolerances(const double* y, const double* chart, double* allowed) const = 0;

  // The longest step that may begin there, s: finite, for where nothing moves any step is right.
  virtual double longest_step(const double* y, const double* slope, const double* chart) const = 0;

  // At a step's end: moves the chart there, y and its slope along.
  virtual void recentre(double* /*y*/, double* /*slope*/, double* /*chart*/) const {}
};

}  // namespace tw
