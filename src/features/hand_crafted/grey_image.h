// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <opencv2/core.hpp>

namespace dxslam {

/// Throws InputError unless the image is CV_8UC1 or CV_8UC3 with sides of 32 to 16384 pixels.
void check_image(const cv::Mat& image);

/// The image itself if it is grey, else converted from BGR. Throws as check_image().
cv::Mat to_grey(const cv::Mat& image);

}  // namespace dxslam
