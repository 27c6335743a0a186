// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "relocalization/confidence.h"

#include <algorithm>
#include <cmath>

#include "relocalization/relocalizer.h"

namespace dxslam {

double relocalization_confidence(const RelocalizationReport& report) {
  if (!report.has_pose) return 0.0;
  const double evidence = 3.0 + 4.0 * std::log(std::max(1, report.matched) / 15.0) +
                          3.5 * std::log(std::max(1, report.inliers) / 25.0);
  return 1.0 / (1.0 + std::exp(-evidence));
}

}  // namespace dxslam
