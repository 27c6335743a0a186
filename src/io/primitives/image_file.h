// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace dxslam {

// Reading of PNG and JPEG files that may be broken. Both functions throw InputError, with the file
// and what is wrong, for a missing, truncated or damaged file (end marker, and for PNG each chunk's
// checksum), other file types, more than 16384 pixels a side or 2^26 in all and undecodable
// content.

/// CV_8UC3 (BGR) or CV_8UC1, as the file has it; an alpha channel is dropped.
cv::Mat read_color_image(const std::string& path);

/// CV_16UC1, raw depth units. 8-bit and colour files are refused.
cv::Mat read_depth_image(const std::string& path);

}  // namespace dxslam
