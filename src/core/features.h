// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace dxslam {

/// A detected point in raw (distorted) pixel coordinates; pixel centres are at integers.
struct Keypoint {
  float x = 0.0F;
  float y = 0.0F;
  float score = 0.0F;  ///< detector confidence, larger is better; comparable within one extractor
  float sigma = 1.0F;  ///< standard deviation of the position in pixels of the image (scale level)
};

/// All a network or detector says about one image (paper III.B).
struct Features {
  std::vector<Keypoint> keypoints;  ///< N, by falling score
  /// N x D, continuous. CV_32F with rows of unit L2 norm, or CV_8U with D bytes (binary).
  cv::Mat descriptors;
  /// Global image descriptor of unit L2 norm; empty where the extractor has none or was not asked.
  std::vector<float> global;

  std::size_t size() const { return keypoints.size(); }
};

}  // namespace dxslam
