// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <opencv2/core.hpp>

namespace dxslam {

/// Mean and deviation of the pixels of a grey image (CV_8UC1), from exact integer sums.
struct PixelStatistics {
  double mean = 0.0;
  double deviation = 0.0;
};
PixelStatistics pixel_statistics(const cv::Mat& grey);

/// Space to depth: `out` (of `type` CV_32F or CV_8S, reallocated where it has another size) gets
/// one place a block of block x block pixels of `grey` (CV_8UC1, both sizes multiples of block),
/// with block * block channels, row by row of the block. Each is pixel * scale + offset; as CV_8S
/// rounded to the nearest integer and limited to -127..127.
void pixels_to_blocks(const cv::Mat& grey, int block, float scale, float offset, int type,
                      cv::Mat& out);

}  // namespace dxslam
