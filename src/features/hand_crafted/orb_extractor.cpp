// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/hand_crafted/orb_extractor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "features/hand_crafted/grey_image.h"
#include "features/post_processing/keypoint_selection.h"
#include "features/stage_timer.h"

namespace dxslam {
namespace {

constexpr int kFeatures = 1000;
constexpr int kLevels = 8;
constexpr double kScaleFactor = 1.2;
constexpr int kPatch = 31;
constexpr int kOpenCvEdge = 31;
constexpr int kOpenCvFastThreshold = 20;
/// For spreading: a low threshold finds corners in dull and dark places.
constexpr int kLowFastThreshold = 7;
constexpr int kEdge = 19;  // pixels of a level; the patch of a descriptor must fit
constexpr double kSpread = 0.25;
constexpr int kSpreadCell = 40;
constexpr float kMaxDistance = 64.0F;

cv::Ptr<cv::ORB> create(int count, int edge) {
  return cv::ORB::create(count, static_cast<float>(kScaleFactor), kLevels, edge, 0, 2,
                         cv::ORB::HARRIS_SCORE, kPatch, kOpenCvFastThreshold);
}

double level_scale(int level) {
  static const std::array<double, kLevels> kScales = [] {
    std::array<double, kLevels> scales{};
    for (int i = 0; i < kLevels; ++i) {
      scales[static_cast<std::size_t>(i)] = std::pow(kScaleFactor, i);
    }
    return scales;
  }();
  return kScales[static_cast<std::size_t>(level)];
}

cv::Size level_size(cv::Size image, int level) {
  return {cvRound(image.width / level_scale(level)), cvRound(image.height / level_scale(level))};
}

/// Where a keypoint lies in the image. OpenCV multiplies the pixel of a level by the nominal scale;
/// but it is pixel centres that scale, and the level's size was rounded: up to 2 pixels apart.
cv::Point2f pixel_in_image(const cv::KeyPoint& keypoint, cv::Size image) {
  const cv::Size level = level_size(image, keypoint.octave);
  const auto nominal = static_cast<float>(level_scale(keypoint.octave));
  const auto moved = [nominal](float x, int pixels, int level_pixels) {
    const float scale = static_cast<float>(pixels) / static_cast<float>(level_pixels);
    return (x / nominal + 0.5F) * scale - 0.5F;
  };
  return {moved(keypoint.pt.x, image.width, level.width),
          moved(keypoint.pt.y, image.height, level.height)};
}

/// Features by falling score, with their descriptors.
Features to_features(const std::vector<cv::KeyPoint>& keypoints, const cv::Mat& descriptors,
                     cv::Size image) {
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
    const cv::Point2f pixel = pixel_in_image(k, image);
    const auto sigma = static_cast<float>(level_scale(k.octave));
    features.keypoints.push_back({pixel.x, pixel.y, k.response, sigma});
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
      : orb_(create(feature_count(options), kOpenCvEdge)) {}

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
    Features features = to_features(keypoints, descriptors, grey.size());
    timer_.stop("orb");
    return features;
  }

 private:
  std::string name_ = "opencv_orb";
  DescriptorTraits traits_ = orb_traits();
  cv::Ptr<cv::ORB> orb_;
  StageTimer timer_;
};

/// Direction from a pixel to the centroid of brightness in the disc around it, degrees: the
/// orientation of an ORB feature.
float orientation(const cv::Mat& image, int x, int y) {
  constexpr int kRadius = kPatch / 2;
  static const std::array<int, kRadius + 1> kHalfWidths = [] {
    std::array<int, kRadius + 1> widths{};
    for (int dy = 0; dy <= kRadius; ++dy) {
      widths[static_cast<std::size_t>(dy)] =
          cvRound(std::sqrt(static_cast<double>(kRadius * kRadius - dy * dy)));
    }
    return widths;
  }();
  int moment_x = 0;
  int moment_y = 0;
  for (int dy = -kRadius; dy <= kRadius; ++dy) {
    const std::uint8_t* row = image.ptr<std::uint8_t>(y + dy) + x;
    const int half = kHalfWidths[static_cast<std::size_t>(std::abs(dy))];
    int sum = 0;
    for (int dx = -half; dx <= half; ++dx) {
      sum += row[dx];
      moment_x += dx * row[dx];
    }
    moment_y += dy * sum;
  }
  return cv::fastAtan2(static_cast<float>(moment_y), static_cast<float>(moment_x));
}

class OrbExtractor final : public FeatureExtractor {
 public:
  explicit OrbExtractor(const ExtractorOptions& options)
      : count_(feature_count(options)),
        spread_(options.spread >= 0.0 ? options.spread : kSpread),
        orb_(create(count_, kEdge)),
        fast_(cv::FastFeatureDetector::create(kLowFastThreshold)) {}

  const std::string& name() const override { return name_; }
  const DescriptorTraits& traits() const override { return traits_; }
  std::vector<StageTime> last_stages() const override { return timer_.stages(); }

  Features extract(const cv::Mat& image, bool) override {
    timer_.start();
    const cv::Mat grey = to_grey(image);
    timer_.stop("preprocess");
    std::vector<cv::KeyPoint> keypoints = detect(grey);
    timer_.stop("detect");
    cv::Mat descriptors;
    orb_->compute(grey, keypoints, descriptors);
    Features features = to_features(keypoints, descriptors, grey.size());
    timer_.stop("describe");
    return features;
  }

 private:
  void build_pyramid(const cv::Mat& grey) {
    pyramid_.resize(kLevels);
    pyramid_[0] = grey;
    for (std::size_t level = 1; level < pyramid_.size(); ++level) {
      cv::resize(pyramid_[level - 1], pyramid_[level],
                 level_size(grey.size(), static_cast<int>(level)), 0, 0, cv::INTER_LINEAR_EXACT);
    }
  }

  /// From the coarsest level on, each gets its share of what is left, falling with the scale; so
  /// what a level cannot use goes to the finer ones.
  std::vector<cv::KeyPoint> detect(const cv::Mat& grey) {
    build_pyramid(grey);
    std::vector<cv::KeyPoint> keypoints;
    constexpr double kRatio = 1.0 / kScaleFactor;
    for (int level = kLevels - 1; level >= 0; --level) {
      // Shares of this level and the finer ones: 1, r, r^2, ... with r = 1/scale.
      const double share =
          std::pow(kRatio, level) * (1.0 - kRatio) / (1.0 - std::pow(kRatio, level + 1));
      const int left = count_ - static_cast<int>(keypoints.size());
      detect_level(level, static_cast<int>(std::lround(left * share)), keypoints);
    }
    return keypoints;
  }

  void detect_level(int level, int count, std::vector<cv::KeyPoint>& keypoints) {
    const cv::Mat& image = pyramid_[static_cast<std::size_t>(level)];
    const cv::Rect inside(kEdge, kEdge, image.cols - 2 * kEdge, image.rows - 2 * kEdge);
    if (inside.width < 8 || inside.height < 8) return;
    corners_.clear();
    fast_->detect(image(inside), corners_);
    candidates_.clear();
    for (const cv::KeyPoint& corner : corners_) {
      candidates_.push_back({cvRound(corner.pt.x), cvRound(corner.pt.y), corner.response});
    }
    select_keypoints(inside.width, inside.height, count, spread_, kSpreadCell, candidates_);
    const auto scale = static_cast<float>(level_scale(level));
    for (const Candidate& c : candidates_) {
      const int x = c.x + kEdge;
      const int y = c.y + kEdge;
      keypoints.emplace_back(static_cast<float>(x) * scale, static_cast<float>(y) * scale,
                             kPatch * scale, orientation(image, x, y), c.score, level);
    }
  }

  std::string name_ = "orb";
  DescriptorTraits traits_ = orb_traits();
  int count_;
  double spread_;
  cv::Ptr<cv::ORB> orb_;
  cv::Ptr<cv::FastFeatureDetector> fast_;
  std::vector<cv::Mat> pyramid_;
  std::vector<cv::KeyPoint> corners_;
  std::vector<Candidate> candidates_;
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
