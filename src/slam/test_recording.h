// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "features/extractor.h"
#include "map/point_scene.h"

namespace dxslam {

inline constexpr int kFrames = 60;

// There and back along the path of the scene.
inline double place(int index) {
  const double t = 2.0 * index / (kFrames - 1);
  return t <= 1.0 ? t : 2.0 - t;
}

// What a made-up recording is like.
struct RecordingKind {
  int points = 1200;     // of the scene
  int frames = kFrames;  // the first of them
  bool binary = false;   // descriptors of 32 bytes, as ORB's, and no global descriptor
};

// A recording without images: the colour image holds the index of a frame, by which the extractor
// finds the keypoints that belong to it.
class Recording {
 public:
  explicit Recording(const RecordingKind& kind = {}) : kind_(kind), scene_(kind.points) {
    for (int i = 0; i < kind.frames; ++i) add(i);
    nothing_.descriptors.create(0, features_.front().descriptors.cols,
                                features_.front().descriptors.type());
  }

  const Camera& camera() const { return scene_.camera(); }
  DescriptorTraits traits() const {
    if (kind_.binary) return {true, 32, 60.0F, 0};
    DescriptorTraits traits = scene_.traits();
    traits.global_dimension = 2;
    return traits;
  }
  const std::string& features_name() const { return kind_.binary ? kOrb : kName; }
  const std::vector<RgbdImage>& images() const { return images_; }
  // A negative index is an image that shows nothing.
  const Features& features(const cv::Mat& color) const {
    std::int32_t index = 0;
    std::memcpy(&index, color.data, sizeof(index));
    if (index < 0) return nothing_;
    return features_.at(static_cast<std::size_t>(index));
  }

 private:
  void add(int index) {
    const FramePtr frame = scene_.frame(index, PointScene::pose(place(index)));
    RgbdImage image;
    image.index = index;
    image.stamp = frame->stamp;
    image.color = cv::Mat::zeros(camera().height, camera().width, CV_8UC1);
    const std::int32_t number = index;
    std::memcpy(image.color.data, &number, sizeof(number));
    image.depth = cv::Mat::zeros(camera().height, camera().width, CV_32FC1);
    Features features;
    for (std::size_t i = 0; i < frame->size(); ++i) {
      const Eigen::Vector2f& p = frame->pixels[i];
      features.keypoints.push_back({p.x(), p.y(), 1.0F, 1.0F});
      // Every other keypoint is without a reading, and may be triangulated.
      if (i % 2 == 0) depth_at(image.depth, p) = frame->depths[i];
    }
    if (kind_.binary) {
      frame->descriptors.convertTo(features.descriptors, CV_8U, 300.0, 128.0);
    } else {
      features.descriptors = frame->descriptors.clone();
      features.encoder.create(1, 1, CV_32FC1);
      features.encoder.at<float>(0, 0) = static_cast<float>(place(index));
    }
    images_.push_back(image);
    features_.push_back(features);
  }
  static float& depth_at(cv::Mat& depth, const Eigen::Vector2f& p) {
    const auto within = [](float x, int size) {
      return std::clamp(static_cast<int>(std::lround(x)), 0, size - 1);
    };
    return depth.at<float>(within(p.y(), depth.rows), within(p.x(), depth.cols));
  }

  static inline const std::string kName = "recording";
  static inline const std::string kOrb = "orb";

  RecordingKind kind_;
  PointScene scene_;
  std::vector<RgbdImage> images_;
  std::vector<Features> features_;
  Features nothing_;
};

inline const Recording& recording() {
  static const Recording made;
  return made;
}

class RecordingExtractor : public FeatureExtractor {
 public:
  /// `broken`: the image, from 0, that cannot be extracted; `broken_global`: the call of global_of.
  /// `made` must outlive this.
  explicit RecordingExtractor(int broken = -1, int broken_global = -1,
                              const Recording& made = recording())
      : made_(made), broken_(broken), broken_global_(broken_global) {}
  const std::string& name() const override { return made_.features_name(); }
  const DescriptorTraits& traits() const override { return traits_; }
  Features extract(const cv::Mat& image, bool) override {
    if (count_++ == broken_) throw std::runtime_error("broken image");
    return made_.features(image);
  }
  std::vector<float> global_of(const cv::Mat& encoder) override {
    if (globals_++ == broken_global_) throw std::runtime_error("broken encoder");
    if (encoder.empty()) return {};
    const float angle = encoder.at<float>(0, 0);
    return {std::cos(angle), std::sin(angle)};
  }

 private:
  const Recording& made_;
  const DescriptorTraits traits_ = made_.traits();
  const int broken_;
  const int broken_global_;
  int count_ = 0;
  int globals_ = 0;
};

}  // namespace dxslam
