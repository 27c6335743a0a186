// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "core/features.h"

namespace dxslam {

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

  /// Whether extract() fills Features::encoder from now on; off at first, and without effect where
  /// there is no global descriptor. Costs a copy of some hundred kilobytes an image.
  virtual void keep_encoder(bool keep) { (void)keep; }
  /// The global descriptor of an image extracted before, from its Features::encoder: equal to what
  /// extract() with the global descriptor gives. Empty where there is none. May be called from any
  /// thread, also while another is inside extract(); calls of it wait for one another.
  virtual std::vector<float> global_of(const cv::Mat& encoder) {
    (void)encoder;
    return {};
  }

  /// What runs the extractor, e.g. "int8" or "f32"; "cpu" where there is no network.
  virtual std::string precision() const { return "cpu"; }
  /// SHA-256 of the network's weights; empty where there is no network. Descriptors of different
  /// weights cannot be compared.
  virtual std::string model_hash() const { return ""; }
  /// Sentences for the user about what works less well than it could: a cache that cannot be used,
  /// weights that cannot be verified.
  virtual std::vector<std::string> notes() const { return {}; }
  /// Steps of the last extract() in order, e.g. preprocess, network, detect, describe.
  virtual std::vector<StageTime> last_stages() const { return {}; }
};

}  // namespace dxslam
