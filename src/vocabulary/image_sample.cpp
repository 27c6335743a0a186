// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "vocabulary/image_sample.h"

namespace dxslam {
namespace {

std::size_t bytes_of(const cv::Mat& image) { return image.total() * image.elemSize(); }

}  // namespace

void ImageSample::add(const cv::Mat& descriptors) {
  const std::size_t index = offered_++;
  if (index % stride_ != 0) return;
  images_.push_back(descriptors.clone());
  bytes_ += bytes_of(descriptors);
  while (bytes_ > max_bytes_ && images_.size() > 1) thin_out();
}

// Keeps every second image: those whose index is a multiple of twice the stride.
void ImageSample::thin_out() {
  std::vector<cv::Mat> kept;
  bytes_ = 0;
  for (std::size_t i = 0; i < images_.size(); i += 2) {
    kept.push_back(images_[i]);
    bytes_ += bytes_of(images_[i]);
  }
  images_ = std::move(kept);
  stride_ *= 2;
}

cv::Mat ImageSample::all_rows() const {
  cv::Mat rows;
  for (const cv::Mat& image : images_) {
    if (image.rows > 0) rows.push_back(image);
  }
  return rows;
}

void ImageSample::restore(std::vector<cv::Mat> images, std::size_t stride, std::size_t offered) {
  images_ = std::move(images);
  stride_ = stride;
  offered_ = offered;
  bytes_ = 0;
  for (const cv::Mat& image : images_) bytes_ += bytes_of(image);
}

}  // namespace dxslam
