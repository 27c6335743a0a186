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
  /// What the extractor's global_of() makes the global descriptor of, later and if ever; its form
  /// is the extractor's own. Empty unless keep_encoder() was asked for.
  cv::Mat encoder;

  std::size_t size() const { return keypoints.size(); }
};

/// How descriptors of one extractor are compared.
struct DescriptorTraits {
  bool binary = false;  ///< bytes compared by Hamming distance, else floats compared by L2 distance
  int dimension = 0;    ///< floats, or bytes where binary
  /// Farthest distance at which two descriptors may be of the same point: L2 of unit vectors
  /// (0 to 2), or differing bits where binary.
  float max_distance = 0.0F;
  int global_dimension = 0;  ///< floats of the global descriptor; 0 where there is none
};

/// Wall-clock time of one step of an extraction.
struct StageTime {
  const char* name = "";  ///< a string literal
  double ms = 0.0;
};

}  // namespace dxslam
