// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "core/sim3.h"
#include "core/trajectory.h"
#include "evaluation/association.h"
#include "evaluation/statistics.h"

namespace dxslam {

/// How trajectories are compared.
struct AteOptions {
  Alignment alignment = Alignment::kSe3;
  double max_difference = 0.01;  ///< seconds between the stamps of two poses that are compared
};

/// What evaluate_ate() finds.
struct AteReport {
  ErrorStatistics position;     ///< metres
  Sim3 truth_from_estimate;     ///< the alignment found
  std::vector<PosePair> pairs;  ///< compared poses; the estimates are aligned
  std::vector<double> errors;   ///< metres, one per pair
};

/// Absolute trajectory error (Sturm et al. 2012): distances of matched positions after aligning the
/// estimate to the truth. Throws InputError if no stamps match or the alignment is undefined.
AteReport evaluate_ate(const Trajectory& truth, const Trajectory& estimate,
                       const AteOptions& options = {});

}  // namespace dxslam
