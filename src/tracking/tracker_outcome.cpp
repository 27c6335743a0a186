// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors

// How it went with the frame that the tracker was given last.
#include <optional>

#include "optimization/pose_optimizer.h"
#include "tracking/tracker.h"

namespace dxslam {

std::optional<Matrix6d> Tracker::covariance() const {
  return pose_covariance(information_, variance_factor_);
}

LossReason Tracker::loss_reason() const {
  const int needed = local_ ? options_.min_inliers : options_.min_start_points;
  if (keypoints_ < needed) return LossReason::kFewKeypoints;
  if (!local_) return LossReason::kFewDepths;
  if (disbelieved_) return LossReason::kDisbelieved;
  return most_matches_ < needed ? LossReason::kFewMatches : LossReason::kNoAgreement;
}

}  // namespace dxslam
