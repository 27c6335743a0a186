// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "core/features.h"
#include "map/map.h"

namespace dxslam {

/// All map points that a group of keyframes sees, each once, with one or more descriptors.
struct GroupPoints {
  std::vector<PointId> ids;
  std::vector<Eigen::Vector3d> positions;  ///< in world, one per point
  cv::Mat descriptors;                     ///< one row per descriptor
  std::vector<int> point_of_row;           ///< index into ids
};

/// Gathers the points of the keyframes, in their order. A point's descriptors are those of its
/// observations in these keyframes, up to `descriptors_per_point`; of alike ones (nearer than a
/// third of `max_distance`) the first stays. Not more than `max_rows` rows.
GroupPoints gather_group_points(const Map& map, const std::vector<KeyframeId>& keyframes,
                                int descriptors_per_point, int max_rows, float max_distance);

/// Keypoint `keypoint` may be an image of point `point` (index into GroupPoints::ids).
struct GroupMatch {
  int keypoint = 0;
  int point = 0;
  float distance = 0.0F;  ///< of the descriptors
};

/// Mutual nearest neighbours of the first `max_keypoints` descriptors of a frame and the points of
/// a group, nearer than `max_distance` and nearer than `ratio` times the second best point, where
/// points less than 0.05 m apart are no rivals. By rising keypoint.
std::vector<GroupMatch> match_group(const cv::Mat& frame_descriptors, int max_keypoints,
                                    const GroupPoints& group, float max_distance, float ratio);

}  // namespace dxslam
