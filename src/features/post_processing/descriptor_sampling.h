// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "features/network/tensor_view.h"

namespace dxslam {

/// How pixels of the network's input lie on a descriptor map.
struct SamplingGrid {
  int stride = 8;
  /// Map position (W/stride - 1)/(W - 1) * x as in HF-Net, else (x + 0.5)/stride - 0.5.
  bool align_corners = false;
};

/// Descriptors at sub-pixel positions (of the network's input) by bilinear interpolation of the
/// dense map outside the network, clamped at the rim, then scaled to unit L2 norm (paper III.B).
/// Returns N x channels CV_32F; a zero vector stays zero.
cv::Mat sample_descriptors(const TensorView& map, const SamplingGrid& grid,
                           const std::vector<cv::Point2f>& positions);

/// One value of a one-channel map, sampled the same way, without normalisation.
float sample_value(const TensorView& map, const SamplingGrid& grid, const cv::Point2f& position);

}  // namespace dxslam
