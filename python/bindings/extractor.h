// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "features/extractor.h"
#include "features/extractor_options.h"

namespace dxslam::python {

/// An extractor that Python, a System and a Map may use at once, each in turn. Copies are the same
/// extractor.
class SharedExtractor final : public FeatureExtractor {
 public:
  explicit SharedExtractor(std::unique_ptr<FeatureExtractor> extractor)
      : shared_(std::make_shared<Shared>()) {
    shared_->extractor = std::move(extractor);
  }

  const std::string& name() const override { return shared_->extractor->name(); }
  const DescriptorTraits& traits() const override { return shared_->extractor->traits(); }
  Features extract(const cv::Mat& image, bool with_global) override {
    const std::lock_guard lock(shared_->mutex);
    return shared_->extractor->extract(image, with_global);
  }
  void keep_encoder(bool keep) override {
    const std::lock_guard lock(shared_->mutex);
    shared_->extractor->keep_encoder(keep);
  }
  std::vector<float> global_of(const cv::Mat& encoder) override {
    return shared_->extractor->global_of(encoder);
  }
  std::string precision() const override { return shared_->extractor->precision(); }
  std::string model_hash() const override { return shared_->extractor->model_hash(); }
  std::vector<std::string> notes() const override { return shared_->extractor->notes(); }
  std::vector<StageTime> last_stages() const override {
    const std::lock_guard lock(shared_->mutex);
    return shared_->extractor->last_stages();
  }

 private:
  struct Shared {
    std::mutex mutex;
    std::unique_ptr<FeatureExtractor> extractor;
  };
  std::shared_ptr<Shared> shared_;
};

/// Loads it so that Ctrl-C works. With the GIL.
SharedExtractor load_extractor(const std::string& name, const ExtractorOptions& options);

}  // namespace dxslam::python
