// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "core/features.h"
#include "map/map.h"

namespace dxslam {

/// Where and how closely a point of one keyframe is sought among the keypoints of another.
struct PointFusion {
  double radius = 4.0;           ///< pixels at 640 wide
  double ratio = 0.95;           ///< nearest to second nearest descriptor distance
  double depth_tolerance = 0.1;  ///< relative difference of predicted and measured depth
  DescriptorTraits traits;
};

/// The points that a keyframe sees, in the order of its keypoints.
std::vector<PointId> points_seen(const Map& map, KeyframeId keyframe);

/// Projects those of `points` that keyframe `target` does not see into it and binds each to the
/// keypoint it matches, or merges it with the point that keypoint is bound to already; of two
/// merged points the one seen by more keyframes stays. Returns how many were bound or merged.
int fuse_points(const std::vector<PointId>& points, KeyframeId target, const PointFusion& fusion,
                Map& map);

}  // namespace dxslam
