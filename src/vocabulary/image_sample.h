// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <opencv2/core.hpp>
#include <vector>

namespace dxslam {

/// The descriptors of some of the images of a stream of any length, evenly over it and within a
/// memory limit: of every 1st, 2nd, 4th, ... image, as the limit demands.
class ImageSample {
 public:
  explicit ImageSample(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// Offers the next image of the stream; its descriptors are copied if it is taken.
  void add(const cv::Mat& descriptors);
  const std::vector<cv::Mat>& images() const { return images_; }
  /// All rows in one matrix.
  cv::Mat all_rows() const;

  // For checkpoints.
  std::size_t stride() const { return stride_; }
  std::size_t offered() const { return offered_; }
  void restore(std::vector<cv::Mat> images, std::size_t stride, std::size_t offered);

 private:
  void thin_out();

  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::size_t stride_ = 1;
  std::size_t offered_ = 0;
  std::vector<cv::Mat> images_;
};

}  // namespace dxslam
