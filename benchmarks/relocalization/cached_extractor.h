// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <string>

#include "features/extractor.h"

namespace dxslam::benchmark {

/// Keeps the features of every image in a folder, one file an image by its content, so that trying
/// another setting of relocalization costs no extraction. The global descriptor is always there.
/// The folder serves one extractor only, which nothing checks.
class CachedExtractor : public FeatureExtractor {
 public:
  CachedExtractor(std::unique_ptr<FeatureExtractor> extractor, std::string folder);
  const std::string& name() const override { return extractor_->name(); }
  const DescriptorTraits& traits() const override { return extractor_->traits(); }
  Features extract(const cv::Mat& image, bool with_global) override;

 private:
  std::unique_ptr<FeatureExtractor> extractor_;
  std::string folder_;
};

}  // namespace dxslam::benchmark
