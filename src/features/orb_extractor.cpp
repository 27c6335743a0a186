// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/orb_extractor.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/features2d.hpp>

#include "features/grey_image.h"
#include "features/keypoint_selection.h"
#include "features/stage_timer.h"

namespace dxslam {
namespace {

constexpr int kFeatures = 1000;
constexpr int kLevels = 8;
constexpr double kScaleFactor = 1.2;
constexpr int kEdge = 31;
constexpr int kPatch = 31;
constexpr int kDefaultFastThreshold = 20;
/// For spreading: a low threshold finds corners in dull places, and there is more to choose from.
constexpr int kLowFastThreshold = 7;
constexpr int kChoice = 4;  // candidates a keypoint
constexpr double kSpread = 0.5;
constexpr int kSpreadCell = 40;
constexpr float kMaxDistance = 64.0F;

cv::Ptr<cv::ORB> create(int count, int fast_threshold) {
  return cv::ORB::create(count, static_cast<float>(kScaleFactor), kLevels, kEdge, 0, 2,
                         cv::ORB::HARRIS_SCORE, kPatch, fast_threshold);
}

/// Features by falling score, with their descriptors.
Features to_features(const std::vector<cv::KeyPoint>& keypoints, const cv::Mat& descriptors) {
  std::vector<int> order(keypoints.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return keypoints[static_cast<std::size_t>(a)].response >
           keypoints[static_cast<std::size_t>(b)].response;
  });
  Features features;
  features.keypoints.reserve(keypoints.size());
  features.descriptors.create(static_cast<int>(keypoints.size()), 32, CV_8U);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const cv::KeyPoint& k = keypoints[static_cast<std::size_t>(order[i])];
    const auto sigma = static_cast<float>(std::pow(kScaleFactor, k.octave));
    features.keypoints.push_back({k.pt.x, k.pt.y, k.response, sigma});
    descriptors.row(order[i]).copyTo(features.descriptors.row(static_cast<int>(i)));
  }
  return features;
}

DescriptorTraits orb_traits() {
  DescriptorTraits traits;
  traits.binary = true;
  traits.dimension = 32;
  traits.max_distance = kMaxDistance;
  return traits;
}

int feature_count(const ExtractorOptions& options) {
  return options.max_keypoints > 0 ? options.max_keypoints : kFeatures;
}

class OpenCvOrbExtractor final : public FeatureExtractor {
 public:
  explicit OpenCvOrbExtractor(const ExtractorOptions& options)
      : orb_(create(feature_count(options), kDefaultFastThreshold)) {}

  const std::string& name() const override { return name_; }
  const DescriptorTraits& traits() const override { return traits_; }
  std::vector<StageTime> last_stages() const override { return timer_.stages(); }

  Features extract(const cv::Mat& image, bool) override {
    timer_.start();
    const cv::Mat grey = to_grey(image);
    timer_.stop("preprocess");
    std::vector<cv::KeyPoint> keypoints;
    cv::Mat descriptors;
    orb_->detectAndCompute(grey, cv::noArray(), keypoints, descriptors);
    Features features = to_features(keypoints, descriptors);
    timer_.stop("orb");
    return features;
  }

 private:
  std::string name_ = "opencv_orb";
  DescriptorTraits traits_ = orb_traits();
  cv::Ptr<cv::ORB> orb_;
  StageTimer timer_;
};

class OrbExtractor final : public FeatureExtractor {
 public:
  explicit OrbExtractor(const ExtractorOptions& options)
      : count_(feature_count(options)),
        spread_(options.spread >= 0.0 ? options.spread : kSpread),
        orb_(create(kChoice * count_, kLowFastThreshold)) {}

  const std::string& name() const override { return name_; }
  const DescriptorTraits& traits() const override { return traits_; }
  std::vector<StageTime> last_stages() const override { return timer_.stages(); }

  Features extract(const cv::Mat& image, bool) override {
    timer_.start();
    const cv::Mat grey = to_grey(image);
    timer_.stop("preprocess");
    std::vector<cv::KeyPoint> keypoints;
    orb_->detect(grey, keypoints);
    keypoints = spread(keypoints, grey.size());
    timer_.stop("detect");
    cv::Mat descriptors;
    orb_->compute(grey, keypoints, descriptors);
    Features features = to_features(keypoints, descriptors);
    timer_.stop("describe");
    return features;
  }

 private:
  /// Each level gets its share, falling with the scale; what a level cannot use goes to the next
  /// finer one.
  std::vector<cv::KeyPoint> spread(const std::vector<cv::KeyPoint>& keypoints,
                                   const cv::Size& size) const {
    std::vector<std::vector<Candidate>> levels(kLevels);
    for (std::size_t i = 0; i < keypoints.size(); ++i) {
      const cv::KeyPoint& k = keypoints[i];
      levels[static_cast<std::size_t>(k.octave)].push_back(
          {cvRound(k.pt.x), cvRound(k.pt.y), k.response, static_cast<int>(i)});
    }
    std::vector<cv::KeyPoint> chosen;
    int left = count_;
    for (int level = kLevels - 1; level >= 0; --level) {
      // Of what is left for this level and the finer ones: 1, r, r^2, ... with r = 1/scale.
      const double ratio = 1.0 / kScaleFactor;
      const double share =
          std::pow(ratio, level) * (1.0 - ratio) / (1.0 - std::pow(ratio, level + 1));
      auto& candidates = levels[static_cast<std::size_t>(level)];
      select_keypoints(size.width, size.height, static_cast<int>(std::lround(left * share)),
                       spread_, kSpreadCell, candidates);
      for (const Candidate& c : candidates) {
        chosen.push_back(keypoints[static_cast<std::size_t>(c.index)]);
      }
      left -= static_cast<int>(candidates.size());
    }
    std::reverse(chosen.begin(), chosen.end());
    return chosen;
  }

  std::string name_ = "orb";
  DescriptorTraits traits_ = orb_traits();
  int count_;
  double spread_;
  cv::Ptr<cv::ORB> orb_;
  StageTimer timer_;
};

}  // namespace

std::unique_ptr<FeatureExtractor> make_orb_extractor(const ExtractorOptions& options) {
  return std::make_unique<OrbExtractor>(options);
}

std::unique_ptr<FeatureExtractor> make_opencv_orb_extractor(const ExtractorOptions& options) {
  return std::make_unique<OpenCvOrbExtractor>(options);
}

}  // namespace dxslam
