// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace dxslam {

/// Row `a` of one descriptor matrix belongs to row `b` of another.
struct Match {
  int a = 0;
  int b = 0;
  float distance = 0.0F;  ///< see descriptor_distance
};

/// Brute-force mutual nearest neighbours closer than `max_distance` whose distance is less than
/// `ratio` times that of the second nearest in b (1 turns the ratio test off). By rising a.
std::vector<Match> match_mutual(const cv::Mat& a, const cv::Mat& b, float max_distance,
                                float ratio);

}  // namespace dxslam
