// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/hand_crafted/grey_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "core/error.h"

namespace dxslam {
namespace {

constexpr int kSmallestSide = 32;
constexpr int kLargestSide = 16384;

}  // namespace

void check_image(const cv::Mat& image) {
  if (image.empty()) throw InputError("image is empty, expected 8-bit grey or BGR colour");
  if (image.type() != CV_8UC1 && image.type() != CV_8UC3) {
    throw InputError(fmt::format("image is of type {}, expected 8-bit grey or BGR colour",
                                 cv::typeToString(image.type())));
  }
  const int smallest = std::min(image.cols, image.rows);
  const int largest = std::max(image.cols, image.rows);
  if (smallest < kSmallestSide || largest > kLargestSide) {
    throw InputError(fmt::format("image is {} x {} pixels, expected sides of {} to {}", image.cols,
                                 image.rows, kSmallestSide, kLargestSide));
  }
}

cv::Mat to_grey(const cv::Mat& image) {
  check_image(image);
  if (image.channels() == 1) return image;
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

}  // namespace dxslam
