// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/network/network_input.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "features/hand_crafted/grey_image.h"
#include "features/network/pixel_blocks.h"

namespace dxslam {
namespace {

int round_up(int size, int multiple) { return (size + multiple - 1) / multiple * multiple; }

double normalizing_scale(double deviation, double floor) {
  constexpr double kSmallestVariance = 1e-5;
  if (floor > 0.0) return 1.0 / (deviation + floor);
  return 1.0 / std::sqrt(deviation * deviation + kSmallestVariance);
}

}  // namespace

void NetworkInput::set_channels(const cv::Mat& image) {
  if (image.channels() == description_.channels) {
    channels_ = image;
  } else {
    cv::Mat converted;
    cv::cvtColor(image, converted,
                 description_.channels == 1 ? cv::COLOR_BGR2GRAY : cv::COLOR_GRAY2BGR);
    channels_ = converted;
  }
}

const cv::Mat& NetworkInput::prepare(const cv::Mat& image) {
  check_image(image);
  set_channels(image);
  content_ = image.size();
  if (description_.fixed_width > 0) {
    content_ = {description_.fixed_width, description_.fixed_height};
    scale_x_ = static_cast<float>(image.cols) / static_cast<float>(content_.width);
    scale_y_ = static_cast<float>(image.rows) / static_cast<float>(content_.height);
  }
  padded_ = description_.fixed_width > 0
                ? content_
                : cv::Size(round_up(content_.width, description_.size_multiple),
                           round_up(content_.height, description_.size_multiple));
  set_size();
  if (description_.unshuffle > 1) {
    unshuffle();
  } else if (description_.instance_normalized) {
    normalize();
  }
  return prepared_;
}

void NetworkInput::set_size() {
  if (channels_.size() != content_) {
    cv::resize(channels_, sized_, content_, 0, 0, cv::INTER_LINEAR);
    prepared_ = sized_;
  } else if (padded_ != content_) {
    cv::copyMakeBorder(channels_, sized_, 0, padded_.height - content_.height, 0,
                       padded_.width - content_.width, cv::BORDER_REPLICATE);
    prepared_ = sized_;
  } else {
    const bool gaps_matter = description_.unshuffle == 1;
    prepared_ = channels_.isContinuous() || !gaps_matter ? channels_ : channels_.clone();
  }
}

void NetworkInput::normalize() {
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(prepared_.reshape(1), mean, deviation);
  const double scale = normalizing_scale(deviation[0], description_.deviation_floor);
  prepared_.convertTo(normalized_, CV_32F, scale, -mean[0] * scale);
  prepared_ = normalized_;
}

void NetworkInput::unshuffle() {
  const PixelStatistics found = pixel_statistics(prepared_);
  double scale = normalizing_scale(found.deviation, description_.deviation_floor);
  if (integers_) scale /= description_.quantization_step;
  pixels_to_blocks(prepared_, description_.unshuffle, static_cast<float>(scale),
                   static_cast<float>(-found.mean * scale), integers_ ? CV_8S : CV_32F, blocks_);
  prepared_ = blocks_;
}

PixelArea NetworkInput::area(int border) const {
  const int margin = std::max(border, 1);
  return {margin, margin, content_.width - margin, content_.height - margin};
}

cv::Point2f NetworkInput::to_image(const cv::Point2f& position) const {
  return {(position.x + 0.5F) * scale_x_ - 0.5F, (position.y + 0.5F) * scale_y_ - 0.5F};
}

float NetworkInput::sigma() const { return std::max(1.0F, std::max(scale_x_, scale_y_)); }

}  // namespace dxslam
