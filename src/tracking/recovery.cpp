// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "tracking/recovery.h"

#include <algorithm>

#include "core/reach.h"

namespace dxslam {
namespace {

// After more than this a camera may be anywhere, and nothing counts as near.
constexpr double kLongestStep = 1.0;  // seconds

bool is_near(const RecoveryOptions& options, const RecoveryStep& step) {
  const double seconds = step.seconds > 0.0 ? std::min(step.seconds, kLongestStep) : kLongestStep;
  return is_within_reach(options, step.last_from_camera, seconds);
}

}  // namespace

bool is_believable_recovery(const RecoveryOptions& options, double coverage, int inliers,
                            const RecoveryStep& step) {
  if (!is_near(options, step)) {
    return coverage >= options.far_coverage && inliers >= options.far_inliers;
  }
  return coverage >= (step.was_tracking ? options.min_coverage : options.lost_coverage);
}

}  // namespace dxslam
