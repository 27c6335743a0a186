// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/hand_crafted/brief_descriptor.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/split_mix.h"

namespace dxslam {
namespace {

constexpr int kRadius = 15;
constexpr int kMargin = kRadius + 1;
constexpr int kDirections = 32;
constexpr double kPi = 3.14159265358979323846;
constexpr double kDeviation = 6.2;  // a fifth of the patch, as BRIEF recommends
constexpr std::uint64_t kSeed = 0x9E3779B97F4A7C15ULL;

double gaussian(SplitMix64& random) {
  double sum = -6.0;
  for (int i = 0; i < 12; ++i) sum += random.uniform();
  return sum;
}

cv::Point2d draw_place(SplitMix64& random) {
  for (;;) {
    const double x = kDeviation * gaussian(random);
    const double y = kDeviation * gaussian(random);
    if (x * x + y * y <= (kRadius - 0.5) * (kRadius - 0.5)) return {x, y};
  }
}

/// Direction bin of the centroid of brightness in a disc around a pixel.
int direction(const std::uint8_t* centre, std::ptrdiff_t stride) {
  int moment_x = 0;
  int moment_y = 0;
  for (int y = -kRadius; y <= kRadius; ++y) {
    const int half = static_cast<int>(std::sqrt(static_cast<double>(kRadius * kRadius - y * y)));
    const std::uint8_t* row = centre + y * stride;
    int sum = 0;
    for (int x = -half; x <= half; ++x) {
      sum += row[x];
      moment_x += x * row[x];
    }
    moment_y += y * sum;
  }
  const double angle = std::atan2(static_cast<double>(moment_y), static_cast<double>(moment_x));
  const int bin = static_cast<int>(std::lround(angle / (2.0 * kPi) * kDirections));
  return (bin + kDirections) % kDirections;
}

}  // namespace

BriefDescriptor::BriefDescriptor(bool oriented)
    : oriented_(oriented), patterns_(oriented ? kDirections : 1) {
  SplitMix64 random(kSeed);
  for (int i = 0; i < kBits; ++i) {
    const cv::Point2d first = draw_place(random);
    const cv::Point2d second = draw_place(random);
    for (std::size_t d = 0; d < patterns_.size(); ++d) {
      const double angle = 2.0 * kPi * static_cast<double>(d) / kDirections;
      const double c = std::cos(angle);
      const double s = std::sin(angle);
      const auto turn = [&](double x, double y) {
        return static_cast<std::int8_t>(std::lround(x * c - y * s));
      };
      const auto turn_y = [&](double x, double y) {
        return static_cast<std::int8_t>(std::lround(x * s + y * c));
      };
      patterns_[d][static_cast<std::size_t>(i)] = {turn(first.x, first.y), turn_y(first.x, first.y),
                                                   turn(second.x, second.y),
                                                   turn_y(second.x, second.y)};
    }
  }
}

cv::Mat BriefDescriptor::compute(const cv::Mat& grey,
                                 const std::vector<Keypoint>& keypoints) const {
  cv::Mat smooth;
  cv::GaussianBlur(grey, smooth, {7, 7}, 2.0, 2.0, cv::BORDER_REFLECT_101);
  cv::copyMakeBorder(smooth, smooth, kMargin, kMargin, kMargin, kMargin, cv::BORDER_REFLECT_101);
  const auto stride = static_cast<std::ptrdiff_t>(smooth.step);
  cv::Mat descriptors(static_cast<int>(keypoints.size()), kBits / 8, CV_8U);
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    const int x = std::clamp(cvRound(keypoints[i].x), 0, grey.cols - 1) + kMargin;
    const int y = std::clamp(cvRound(keypoints[i].y), 0, grey.rows - 1) + kMargin;
    const std::uint8_t* centre = smooth.ptr<std::uint8_t>(y) + x;
    const Pattern& pattern =
        patterns_[oriented_ ? static_cast<std::size_t>(direction(centre, stride)) : 0];
    auto* out = descriptors.ptr<std::uint8_t>(static_cast<int>(i));
    for (std::size_t byte = 0; byte < kBits / 8; ++byte) {
      unsigned bits = 0;
      for (std::size_t b = 0; b < 8; ++b) {
        const Test& t = pattern[8 * byte + b];
        const bool less = centre[t.y1 * stride + t.x1] < centre[t.y2 * stride + t.x2];
        bits |= (less ? 1U : 0U) << b;
      }
      out[byte] = static_cast<std::uint8_t>(bits);
    }
  }
  return descriptors;
}

}  // namespace dxslam
