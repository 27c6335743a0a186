// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "tracking/keyframe_decision.h"

#include <algorithm>
#include <numbers>

namespace dxslam {
namespace {

struct DepthCensus {
  int with_depth = 0;
  int unknown = 0;  // of these, not in the map
  float median_depth = 0.0F;
};

DepthCensus take_census(const Frame& frame, const std::vector<PointId>& points) {
  DepthCensus census;
  std::vector<float> depths;
  for (std::size_t i = 0; i < frame.size(); ++i) {
    if (!frame.has_depth(i)) continue;
    depths.push_back(frame.depths[i]);
    if (points[i] == kNoId) ++census.unknown;
  }
  census.with_depth = static_cast<int>(depths.size());
  if (depths.empty()) return census;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  census.median_depth = *middle;
  return census;
}

}  // namespace

bool is_keyframe_due(const KeyframeEvidence& evidence, const Frame& frame,
                     const std::vector<PointId>& points, const KeyframeOptions& options) {
  if (evidence.frames_since_keyframe < options.min_gap) return false;
  const DepthCensus census = take_census(frame, points);
  const double angle =
      rotation_angle(evidence.reference_from_camera, SE3()) * 180.0 / std::numbers::pi;
  const double move = evidence.reference_from_camera.translation().norm();
  const double depth = std::max(0.3, static_cast<double>(census.median_depth));
  const bool turned = angle > options.max_rotation;
  const bool moved = move > options.max_translation * depth;
  const bool few = evidence.tracked_points < options.min_tracked_ratio * evidence.reference_points;
  const bool much_new = census.unknown > options.max_new_ratio * census.with_depth;
  // A camera at rest adds nothing, however long it rests.
  const bool at_rest =
      angle < 0.1 * options.max_rotation && move < 0.1 * options.max_translation * depth;
  const bool long_ago = evidence.frames_since_keyframe >= options.max_gap && !at_rest;
  return turned || moved || few || (much_new && !at_rest) || long_ago;
}

}  // namespace dxslam
