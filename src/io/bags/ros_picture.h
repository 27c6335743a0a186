// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "io/bags/ros_message.h"
#include "io/primitives/image_file.h"

namespace dxslam {

// Pictures of ROS messages as cv::Mat. Every function throws InputError, beginning with `where`,
// for sizes that do not fit the data or what is expected, and for encodings that are not known.

/// CV_8UC3 (BGR) or CV_8UC1 of rgb8, bgr8, rgba8, bgra8, mono8, 8UC1, 8UC3, 16 bits per channel of
/// the same, YUV 4:2:2 and Bayer patterns of 8 bits.
cv::Mat color_of(const RosImage& image, const std::string& where,
                 const std::optional<ExpectedSize>& expected = std::nullopt);
/// CV_16UC1 raw units of 16UC1 and mono16, or CV_32FC1 metres of 32FC1, without readings that are
/// negative or not finite (0).
cv::Mat depth_of(const RosImage& image, const std::string& where,
                 const std::optional<ExpectedSize>& expected = std::nullopt);

/// What compressed_depth_image_transport and RealSense write.
struct CompressedDepth {
  bool rvl = false;                  ///< the lossless coding of Wilson (2017), else PNG
  bool inverse = false;              ///< values are quantised inverse depth of a 32FC1 image
  float scale = 0.0F, shift = 0.0F;  ///< depth = scale / (value - shift) metres, of `inverse`
  std::string_view data;             ///< PNG, or size and runs of RVL
};
CompressedDepth read_compressed_depth(const RosCompressedImage& image, const std::string& where);
/// CV_16UC1 of RVL data.
cv::Mat decode_rvl(std::string_view data, const std::string& where,
                   const std::optional<ExpectedSize>& expected = std::nullopt);
/// CV_32FC1 metres of CV_16UC1 quantised inverse depth.
cv::Mat undo_inverse_depth(const cv::Mat& values, float scale, float shift,
                           const std::string& where);

}  // namespace dxslam
