// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <opencv2/core.hpp>

#include "features/network/model_manifest.h"
#include "features/post_processing/candidate.h"

namespace dxslam {

/// Brings camera images to what a network takes - number of channels; size padded at the bottom
/// and on the right by repeating the rim, or scaled where the network has one size - and positions
/// back to the image. Copies nothing where the image already fits. One thread at a time.
class NetworkInput {
 public:
  /// `integers`: the network takes 8-bit integers of the description's quantization_step.
  explicit NetworkInput(const InputDescription& description, bool integers = false)
      : description_(description), integers_(integers) {}

  /// `image` is CV_8UC1 or CV_8UC3 (BGR). The result is valid until the next call and while
  /// `image` is: CV_8U pixels; CV_32F where they are normalised; blocks of them as the channels of
  /// one place, CV_32F or CV_8S, where the description unshuffles.
  /// Throws InputError for an image of another type, or too small to hold a keypoint.
  const cv::Mat& prepare(const cv::Mat& image);

  /// Of the prepared image, in pixels.
  cv::Size size() const { return padded_; }

  /// Pixels of the prepared image that are not padding and lie at least `border` (and one pixel)
  /// inside.
  PixelArea area(int border) const;
  /// Position in the prepared image to position in the image.
  cv::Point2f to_image(const cv::Point2f& position) const;
  /// Pixels of the image per pixel of the prepared image; 1 unless scaled down.
  float sigma() const;

 private:
  void set_channels(const cv::Mat& image);
  void set_size();
  /// To zero mean and unit deviation, by sums that do not depend on the number of threads.
  void normalize();
  void unshuffle();

  InputDescription description_;
  bool integers_ = false;
  cv::Size content_;  // of the image within the prepared image
  cv::Size padded_;
  float scale_x_ = 1.0F;
  float scale_y_ = 1.0F;
  cv::Mat channels_;
  cv::Mat sized_;
  cv::Mat normalized_;
  cv::Mat blocks_;
  cv::Mat prepared_;
};

}  // namespace dxslam
