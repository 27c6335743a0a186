// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "place/two_view_check.h"

#include <opencv2/calib3d.hpp>
#include <vector>

#include "matching/descriptor_matching.h"

namespace dxslam {

int count_epipolar_inliers(const Features& a, const Features& b, const DescriptorTraits& traits,
                           const TwoViewOptions& options) {
  constexpr std::size_t kLeastMatches = 8;
  constexpr double kConfidence = 0.99;
  if (a.size() < kLeastMatches || b.size() < kLeastMatches) return 0;
  const std::vector<Match> matches = match_mutual(a.descriptors, b.descriptors, traits.max_distance,
                                                  static_cast<float>(options.ratio));
  if (matches.size() < kLeastMatches) return 0;
  std::vector<cv::Point2f> in_a;
  std::vector<cv::Point2f> in_b;
  for (const Match& match : matches) {
    const Keypoint& p = a.keypoints[static_cast<std::size_t>(match.a)];
    const Keypoint& q = b.keypoints[static_cast<std::size_t>(match.b)];
    in_a.emplace_back(p.x, p.y);
    in_b.emplace_back(q.x, q.y);
  }
  cv::Mat mask;
  const cv::Mat fundamental = cv::findFundamentalMat(in_a, in_b, cv::FM_RANSAC, options.max_error,
                                                     kConfidence, options.iterations, mask);
  return fundamental.empty() ? 0 : cv::countNonZero(mask);
}

}  // namespace dxslam
