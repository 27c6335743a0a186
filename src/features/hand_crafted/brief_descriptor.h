// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "core/features.h"

namespace dxslam {

/// BRIEF: 256 comparisons of two smoothed pixels each in a disc of radius 15, at places drawn once
/// from a Gaussian with a fixed seed. Upright, or turned with the direction from the keypoint to
/// the centroid of brightness around it (in 32 steps). Immutable, safe to share between threads.
class BriefDescriptor {
 public:
  static constexpr int kBits = 256;

  explicit BriefDescriptor(bool oriented);

  /// N x 32 CV_8U of a CV_8UC1 image; keypoints are rounded to pixels, the image is continued by
  /// reflection at its rim.
  cv::Mat compute(const cv::Mat& grey, const std::vector<Keypoint>& keypoints) const;

 private:
  struct Test {
    std::int8_t x1, y1, x2, y2;
  };
  using Pattern = std::array<Test, kBits>;

  bool oriented_;
  std::vector<Pattern> patterns_;  // one per direction
};

}  // namespace dxslam
