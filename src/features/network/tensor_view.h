// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>

namespace dxslam {

/// A float map of `channels` values a position, in memory that someone else owns. Strides are in
/// floats; channel_stride is 1 where the values of a position lie side by side (NHWC).
struct TensorView {
  const float* data = nullptr;
  int channels = 0;
  int height = 0;
  int width = 0;
  std::ptrdiff_t channel_stride = 0;
  std::ptrdiff_t row_stride = 0;
  std::ptrdiff_t column_stride = 0;

  const float* at(int y, int x) const { return data + y * row_stride + x * column_stride; }
  float value(int channel, int y, int x) const { return at(y, x)[channel * channel_stride]; }

  static TensorView nchw(const float* data, int channels, int height, int width) {
    return {data, channels, height, width, static_cast<std::ptrdiff_t>(height) * width, width, 1};
  }
  static TensorView nhwc(const float* data, int channels, int height, int width) {
    return {data,    channels, height, width, 1, static_cast<std::ptrdiff_t>(width) * channels,
            channels};
  }
};

}  // namespace dxslam
