// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "tracking/keyframe_decision.h"

#include <algorithm>
#include <numbers>
#include <vector>

namespace dxslam {
namespace {

float median_depth(const Frame& frame) {
  std::vector<float> depths;
  for (const float depth : frame.depths) {
    if (depth > 0.0F) depths.push_back(depth);
  }
  if (depths.empty()) return 0.0F;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return *middle;
}

}  // namespace

bool is_keyframe_due(const KeyframeEvidence& evidence, const Frame& frame,
                     const KeyframeOptions& options) {
  const double angle =
      rotation_angle(evidence.reference_from_camera, SE3()) * 180.0 / std::numbers::pi;
  const double depth = std::max(0.3, static_cast<double>(median_depth(frame)));
  const double move = evidence.reference_from_camera.translation().norm() / depth;
  const bool turned = angle > options.max_rotation;
  const bool moved = move > options.max_translation;
  const bool few =
      evidence.tracked_points < options.min_tracked_ratio * evidence.best_tracked_points;
  // A camera at rest adds nothing, however long it rests.
  const bool at_rest = angle < 0.1 * options.max_rotation && move < 0.1 * options.max_translation;
  const bool long_ago = evidence.frames_since_keyframe >= options.max_gap && !at_rest;
  return turned || moved || few || long_ago;
}

}  // namespace dxslam
