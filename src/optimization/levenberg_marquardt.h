// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <algorithm>
#include <cmath>

#include "optimization/may_go_on.h"

namespace dxslam {

// The iteration that bundle adjustment and pose graph share. Internal to this layer.

constexpr double kInitialDamping = 1e-4;  ///< share of the diagonal of the normal equations

struct DescentReport {
  bool usable = false;     ///< the state is of finite cost, no higher than at the start
  bool cancelled = false;  ///< it might not go on; the state is then of no use
  int iterations = 0;
  double initial_cost = 0.0;
  double final_cost = 0.0;
};

/// Levenberg-Marquardt. Damping falls to a third at most after a step that did what its model had
/// predicted, and rises ever faster after steps that did not help (Nielsen 1999). It ends after
/// `iterations` steps, or when a step gained less than the share `min_decrease` of the cost.
///
/// A Problem holds its state and offers
///   double linearise();              builds the normal equations at the state; returns the cost
///   double propose(double damping);  makes a trial state one damped step away; returns by how much
///                                    the model lowers the cost, not positive if there is no step
///   double trial_cost();             of the trial state
///   void accept();                   makes the trial state the state
template <class Problem>
DescentReport descend(Problem& problem, int iterations, double min_decrease,
                      const MayGoOn& may_go_on) {
  constexpr double kMinDamping = 1e-9;
  constexpr double kMaxDamping = 1e8;  // beyond it no step can help any more
  constexpr double kNothing = 1e-12;   // a cost, in sigma^2, that is rounding only
  DescentReport report;
  double damping = kInitialDamping;
  double growth = 2.0;
  double cost = problem.linearise();
  report.initial_cost = report.final_cost = cost;
  report.usable = std::isfinite(cost);
  if (!report.usable) return report;
  bool fresh = true;
  while (report.iterations < iterations && damping < kMaxDamping) {
    report.cancelled = must_stop(may_go_on);
    if (report.cancelled) break;
    if (!fresh) cost = problem.linearise();
    fresh = true;
    ++report.iterations;
    const double predicted = problem.propose(damping);
    if (predicted > 0.0 && predicted < kNothing) break;
    const double trial_cost = predicted > 0.0 ? problem.trial_cost() : cost;
    if (!(trial_cost < cost)) {
      damping *= growth;
      growth *= 2.0;
      continue;
    }
    const double gain = 2.0 * (cost - trial_cost) / predicted - 1.0;
    damping = std::max(kMinDamping, damping * std::max(1.0 / 3.0, 1.0 - gain * gain * gain));
    growth = 2.0;
    problem.accept();
    report.final_cost = trial_cost;
    fresh = false;
    if (cost - trial_cost < min_decrease * cost) break;
  }
  report.usable = !report.cancelled;
  return report;
}

}  // namespace dxslam
