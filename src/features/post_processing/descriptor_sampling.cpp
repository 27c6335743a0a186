// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/post_processing/descriptor_sampling.h"

#include <algorithm>
#include <cmath>

#include "core/simd.h"

namespace dxslam {
namespace {

constexpr int kLanes = 16;

/// The four neighbours of a position and their weights.
struct Corners {
  const float* data[4];
  float weight[4];
};

float map_coordinate(float x, int cells, const SamplingGrid& grid) {
  const auto stride = static_cast<float>(grid.stride);
  const auto last = static_cast<float>(cells - 1);
  const float position = grid.align_corners ? x * last / (static_cast<float>(cells) * stride - 1.0F)
                                            : (x + 0.5F) / stride - 0.5F;
  return std::clamp(position, 0.0F, last);
}

Corners find_corners(const TensorView& map, const SamplingGrid& grid, const cv::Point2f& position) {
  const float x = map_coordinate(position.x, map.width, grid);
  const float y = map_coordinate(position.y, map.height, grid);
  const int x0 = static_cast<int>(x);
  const int y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, map.width - 1);
  const int y1 = std::min(y0 + 1, map.height - 1);
  const float fx = x - static_cast<float>(x0);
  const float fy = y - static_cast<float>(y0);
  return {{map.at(y0, x0), map.at(y0, x1), map.at(y1, x0), map.at(y1, x1)},
          {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy}};
}

DXSLAM_INLINE_KERNEL void blend_contiguous(const Corners& corners, int channels, float* out) {
  const float* a = corners.data[0];
  const float* b = corners.data[1];
  const float* c = corners.data[2];
  const float* d = corners.data[3];
  const float wa = corners.weight[0];
  const float wb = corners.weight[1];
  const float wc = corners.weight[2];
  const float wd = corners.weight[3];
  float lane_sum[kLanes] = {};
  const int whole = channels - channels % kLanes;
  for (int i = 0; i < whole; i += kLanes) {
    for (int j = 0; j < kLanes; ++j) {
      const float v = wa * a[i + j] + wb * b[i + j] + wc * c[i + j] + wd * d[i + j];
      out[i + j] = v;
      lane_sum[j] += v * v;
    }
  }
  float sum = 0.0F;
  for (int i = whole; i < channels; ++i) {
    const float v = wa * a[i] + wb * b[i] + wc * c[i] + wd * d[i];
    out[i] = v;
    sum += v * v;
  }
  for (int j = 0; j < kLanes; ++j) sum += lane_sum[j];
  const float scale = sum > 0.0F ? 1.0F / std::sqrt(sum) : 0.0F;
  for (int i = 0; i < channels; ++i) out[i] *= scale;
}

/// Brings the values of the corners side by side, where the map keeps them apart.
Corners gather(const Corners& corners, const TensorView& map, std::vector<float>& buffer) {
  buffer.resize(4 * static_cast<std::size_t>(map.channels));
  Corners gathered = corners;
  for (int k = 0; k < 4; ++k) {
    float* out = buffer.data() + static_cast<std::size_t>(k) * map.channels;
    for (int i = 0; i < map.channels; ++i) out[i] = corners.data[k][i * map.channel_stride];
    gathered.data[k] = out;
  }
  return gathered;
}

}  // namespace

cv::Mat sample_descriptors(const TensorView& map, const SamplingGrid& grid,
                           const std::vector<cv::Point2f>& positions) {
  cv::Mat descriptors(static_cast<int>(positions.size()), map.channels, CV_32F);
  const auto blend = simd_kernel<blend_contiguous>();
  std::vector<float> buffer;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    Corners corners = find_corners(map, grid, positions[i]);
    if (map.channel_stride != 1) corners = gather(corners, map, buffer);
    blend(corners, map.channels, descriptors.ptr<float>(static_cast<int>(i)));
  }
  return descriptors;
}

float sample_value(const TensorView& map, const SamplingGrid& grid, const cv::Point2f& position) {
  const Corners corners = find_corners(map, grid, position);
  float value = 0.0F;
  for (int k = 0; k < 4; ++k) value += corners.weight[k] * corners.data[k][0];
  return value;
}

}  // namespace dxslam
