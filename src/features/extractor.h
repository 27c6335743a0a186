// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <string>

#include "core/features.h"

namespace dxslam {

/// How descriptors of one extractor are compared.
struct DescriptorTraits {
  bool binary = false;  ///< bytes compared by Hamming distance, else floats compared by L2 distance
  int dimension = 0;    ///< floats, or bytes where binary
  /// Farthest distance at which two descriptors may be of the same point: L2 of unit vectors
  /// (0 to 2), or differing bits where binary.
  float max_distance = 0.0F;
  int global_dimension = 0;  ///< floats of the global descriptor; 0 where there is none
};

/// Image in, keypoints and descriptors out (paper III.B): the one interface behind which ORB,
/// networks and their combinations stand. An extractor serves one thread at a time.
class FeatureExtractor {
 public:
  virtual ~FeatureExtractor() = default;
  virtual const std::string& name() const = 0;
  virtual const DescriptorTraits& traits() const = 0;
  /// `image` is CV_8UC1 or CV_8UC3 (BGR), of any size the extractor supports. The global
  /// descriptor is computed only if asked for and if the extractor has one.
  /// Throws InputError if the image cannot be used.
  virtual Features extract(const cv::Mat& image, bool with_global) = 0;
};

}  // namespace dxslam
