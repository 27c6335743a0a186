// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace dxslam {

// Reading of image files that may be broken: PNG, JPEG, BMP, PGM, PPM, TIFF and EXR, told apart by
// their content. The functions throw InputError, with the file and what is wrong, for a missing,
// truncated or damaged file and for other types. Nothing is decoded before its size is known to be
// the expected one and what it costs is within bounds (io/primitives/limits.h). They print
// nothing and may be called from any thread. Pixels are as stored: an orientation in the EXIF data
// is not applied, as the calibration is that of the sensor.

/// What the size must be, where the caller knows, and where that stands ("calibration.yaml").
struct ExpectedSize {
  cv::Size size;
  std::string_view source;
};

/// CV_8UC3 (BGR) or CV_8UC1, as the file has it; an alpha channel is dropped. Colour of 16 bits is
/// scaled to 8. Grey of 16 bits is refused: it is a depth image.
cv::Mat read_color_image(const std::string& path,
                         const std::optional<ExpectedSize>& expected = std::nullopt);

/// CV_16UC1, raw depth units, or, from TIFF and EXR, CV_32FC1 in metres, 0 where the file has a
/// number that is negative or not finite. 8-bit and colour files are refused.
cv::Mat read_depth_image(const std::string& path,
                         const std::optional<ExpectedSize>& expected = std::nullopt);

/// The same of a file's bytes; `where` stands for the file in messages.
cv::Mat decode_color_image(std::string_view bytes, const std::string& where,
                           const std::optional<ExpectedSize>& expected = std::nullopt);
cv::Mat decode_depth_image(std::string_view bytes, const std::string& where,
                           const std::optional<ExpectedSize>& expected = std::nullopt);

/// The bytes of a PNG or JPEG (quality 95) file, as the ending of `path` says, of an image that is
/// CV_8UC1, CV_8UC3 (BGR) or, for PNG, CV_16UC1. Throws InputError for other endings.
std::string encode_image(const std::string& path, const cv::Mat& image);
/// CV_8UC1 or CV_8UC3 (BGR); `quality` 1 to 100.
std::string encode_jpeg(const cv::Mat& image, int quality);

/// Whether the name ends as those of files that read_color_image() reads.
bool has_image_ending(const std::filesystem::path& path);
/// Whether a file that begins with these bytes (16 are enough) is an image.
bool begins_as_image(std::string_view start);

}  // namespace dxslam
