// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "core/frame.h"
#include "matching/descriptor_matching.h"
#include "matching/keypoint_grid.h"

namespace dxslam {

/// A described point expected at a pixel.
struct PixelPrediction {
  int descriptor_row = 0;                           ///< row in the descriptor matrix of the points
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();  ///< undistorted
  float radius = 0.0F;                              ///< pixels; where the keypoint may lie
  float depth = 0.0F;  ///< expected depth, metres; 0 switches the depth check off
};

struct GuidedMatchingOptions {
  float max_distance = 0.0F;  ///< of descriptors, see DescriptorTraits
  float ratio = 1.0F;         ///< against the second nearest within the radius; 1: off
  float depth_tolerance =
      0.15F;  ///< a keypoint whose depth differs by more (relative) is passed over
};

/// For each prediction the nearest descriptor among the keypoints of `frame` within the radius.
/// A keypoint goes to the prediction with the smallest distance. Match::a is the index of the
/// prediction, Match::b the keypoint; by rising a. `blocked` (empty or one per keypoint) marks
/// keypoints that may not be used.
std::vector<Match> match_guided(const std::vector<PixelPrediction>& predictions,
                                const cv::Mat& point_descriptors, const Frame& frame,
                                const KeypointGrid& grid, const std::vector<char>& blocked,
                                const GuidedMatchingOptions& options);

}  // namespace dxslam
