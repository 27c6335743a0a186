// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/hand_crafted/brief_extractor.h"

#include "features/hand_crafted/brief_descriptor.h"
#include "features/hand_crafted/grey_image.h"
#include "features/stage_timer.h"

namespace dxslam {
namespace {

constexpr float kMaxDistance = 64.0F;

class BriefExtractor final : public FeatureExtractor {
 public:
  BriefExtractor(std::unique_ptr<FeatureExtractor> detector, bool oriented)
      : detector_(std::move(detector)),
        brief_(oriented),
        name_(detector_->name() + (oriented ? "+rbrief" : "+brief")) {
    traits_.binary = true;
    traits_.dimension = BriefDescriptor::kBits / 8;
    traits_.max_distance = kMaxDistance;
    traits_.global_dimension = detector_->traits().global_dimension;
  }

  const std::string& name() const override { return name_; }
  const DescriptorTraits& traits() const override { return traits_; }
  std::string precision() const override { return detector_->precision(); }
  std::string model_hash() const override { return detector_->model_hash(); }
  std::vector<StageTime> last_stages() const override {
    auto stages = detector_->last_stages();
    stages.insert(stages.end(), timer_.stages().begin(), timer_.stages().end());
    return stages;
  }

  Features extract(const cv::Mat& image, bool with_global) override {
    Features features = detector_->extract(image, with_global);
    timer_.start();
    features.descriptors = brief_.compute(to_grey(image), features.keypoints);
    timer_.stop("brief");
    return features;
  }

  void keep_encoder(bool keep) override { detector_->keep_encoder(keep); }
  std::vector<float> global_of(const cv::Mat& encoder) override {
    return detector_->global_of(encoder);
  }

 private:
  std::unique_ptr<FeatureExtractor> detector_;
  BriefDescriptor brief_;
  std::string name_;
  DescriptorTraits traits_;
  StageTimer timer_;
};

}  // namespace

std::unique_ptr<FeatureExtractor> make_brief_extractor(std::unique_ptr<FeatureExtractor> detector,
                                                       bool oriented) {
  return std::make_unique<BriefExtractor>(std::move(detector), oriented);
}

}  // namespace dxslam
