// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/texture.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/error.h"

namespace dxslam {
namespace {

constexpr int kMaxTaps = 4;  // samples along the long axis of a pixel's footprint

bool is_power_of_two(int value) { return value > 0 && (value & (value - 1)) == 0; }

// One byte per channel to one 16-bit lane per channel, in the order B, R, G.
inline std::uint64_t spread(std::uint32_t texel) {
  return (texel & 0xFF00FFU) | (static_cast<std::uint64_t>(texel >> 8 & 0xFFU) << 32);
}

}  // namespace

Texture::Texture(const cv::Mat& image) {
  require(image.type() == CV_8UC3, "texture image must be CV_8UC3");
  require(is_power_of_two(image.cols) && is_power_of_two(image.rows),
          "texture sides must be powers of two");
  Level base{image.cols, image.rows, {}};
  base.texels.reserve(image.total());
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const cv::Vec3b& c = image.at<cv::Vec3b>(y, x);
      base.texels.push_back(c[0] | c[1] << 8 | c[2] << 16);
    }
  }
  levels_.push_back(std::move(base));
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Level& fine = levels_.back();
    Level coarse{std::max(fine.width / 2, 1), std::max(fine.height / 2, 1), {}};
    coarse.texels.reserve(static_cast<std::size_t>(coarse.width) * coarse.height);
    const int step_x = fine.width / coarse.width, step_y = fine.height / coarse.height;
    for (int y = 0; y < coarse.height; ++y) {
      for (int x = 0; x < coarse.width; ++x) {
        std::uint64_t sum = 0;
        for (int k = 0; k < 4; ++k) {
          const int fine_x = x * step_x + (k & 1) * (step_x - 1);
          const int fine_y = y * step_y + (k >> 1) * (step_y - 1);
          sum += spread(fine.texels[static_cast<std::size_t>(fine_y) * fine.width + fine_x]);
        }
        sum += 0x000200020002ULL;
        coarse.texels.push_back(static_cast<std::uint32_t>(
            (sum >> 2 & 0xFF) | (sum >> 34 & 0xFF) << 8 | (sum >> 18 & 0xFF) << 16));
      }
    }
    levels_.push_back(std::move(coarse));
  }
}

cv::Vec3f Texture::mean() const {
  const std::uint32_t texel = levels_.back().texels[0];
  return {static_cast<float>(texel & 0xFF), static_cast<float>(texel >> 8 & 0xFF),
          static_cast<float>(texel >> 16 & 0xFF)};
}

// The four weights sum to 256, so every lane stays below 2^16 and the result is 8.8 fixed point.
[[gnu::always_inline]] inline std::uint64_t Texture::bilinear(const Level& level, float u, float v,
                                                              bool tiled) {
  float x = u * static_cast<float>(level.width) - 0.5F;
  float y = v * static_cast<float>(level.height) - 0.5F;
  if (!tiled) {
    x = std::clamp(x, 0.0F, static_cast<float>(level.width - 1));
    y = std::clamp(y, 0.0F, static_cast<float>(level.height - 1));
  }
  // Truncation of a shifted value is a floor and far cheaper.
  constexpr int kShift = 1 << 20;
  const int fixed_x = static_cast<int>((x + 4096.0F) * 256.0F),
            fixed_y = static_cast<int>((y + 4096.0F) * 256.0F);
  const unsigned fx = static_cast<unsigned>(fixed_x) & 255U,
                 fy = static_cast<unsigned>(fixed_y) & 255U;
  const int base_x = (fixed_x - kShift) >> 8, base_y = (fixed_y - kShift) >> 8;
  int x0 = base_x & (level.width - 1), y0 = base_y & (level.height - 1);
  int x1 = (base_x + 1) & (level.width - 1), y1 = (base_y + 1) & (level.height - 1);
  if (!tiled) {
    x1 = std::min(base_x + 1, level.width - 1);
    y1 = std::min(base_y + 1, level.height - 1);
  }
  const std::uint32_t* row0 = level.texels.data() + static_cast<std::size_t>(y0) * level.width;
  const std::uint32_t* row1 = level.texels.data() + static_cast<std::size_t>(y1) * level.width;
  const unsigned w11 = (fx * fy + 128U) >> 8;
  return spread(row0[x0]) * (256U - fx - fy + w11) + spread(row0[x1]) * (fx - w11) +
         spread(row1[x0]) * (fy - w11) + spread(row1[x1]) * w11;
}

void Texture::sample(float u, float v, float du_dx, float dv_dx, float du_dy, float dv_dy,
                     bool tiled, float bgr[3]) const {
  const float w = static_cast<float>(width()), h = static_cast<float>(height());
  float along_u = du_dx, along_v = dv_dx;
  float major = (du_dx * w) * (du_dx * w) + (dv_dx * h) * (dv_dx * h);
  float minor = (du_dy * w) * (du_dy * w) + (dv_dy * h) * (dv_dy * h);
  if (minor > major) {
    std::swap(minor, major);
    along_u = du_dy;
    along_v = dv_dy;
  }
  major = std::sqrt(major);
  minor = std::max(std::sqrt(minor), major / kMaxTaps);
  const int taps = major <= 1.0F ? 1 : std::min(kMaxTaps, static_cast<int>(major / minor + 0.5F));
  const float finest = std::max(minor, 1e-6F);
  // log2 by the exponent and a straight line between powers: smooth, monotone, cheap.
  const auto bits = std::bit_cast<std::uint32_t>(finest);
  const float log2 = static_cast<float>(static_cast<int>(bits >> 23) - 127) +
                     static_cast<float>(bits & 0x7FFFFFU) * 0x1.0p-23F;
  const float lod = std::clamp(log2, 0.0F, static_cast<float>(levels_.size() - 1));
  const int level = static_cast<int>(lod);
  const float blend = lod - static_cast<float>(level);
  const bool two_levels = blend > 0.004F && level + 1 < static_cast<int>(levels_.size());
  float sum[3] = {0, 0, 0};
  for (int tap = 0; tap < taps; ++tap) {
    const float shift = (static_cast<float>(tap) + 0.5F) / static_cast<float>(taps) - 0.5F;
    const float tap_u = u + along_u * shift, tap_v = v + along_v * shift;
    const std::uint64_t a = bilinear(levels_[level], tap_u, tap_v, tiled);
    const std::uint64_t b = two_levels ? bilinear(levels_[level + 1], tap_u, tap_v, tiled) : a;
    const int shifts[3] = {0, 32, 16};
    for (int c = 0; c < 3; ++c) {
      const float fine = static_cast<float>(a >> shifts[c] & 0xFFFF);
      const float coarse = static_cast<float>(b >> shifts[c] & 0xFFFF);
      sum[c] += fine + blend * (coarse - fine);
    }
  }
  for (int c = 0; c < 3; ++c) bgr[c] = sum[c] / (256.0F * static_cast<float>(taps));
}

}  // namespace dxslam
