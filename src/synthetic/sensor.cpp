// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/sensor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "synthetic/random.h"

namespace dxslam {
namespace {

constexpr double kReferenceBf = 525.0 * 0.075;       // pixel metres of the sensor modelled
constexpr float kNearest = 0.35F, kFarthest = 8.0F;  // metres
constexpr int kField = 256;                          // side of the tables of noise

/// Standard normal numbers: independent, and of patches about three pixels wide.
struct NoiseTables {
  std::vector<float> white, smooth;
};

const NoiseTables& noise_tables() {
  static const NoiseTables tables = [] {
    NoiseTables t;
    Random random(0xD15C0);
    t.white.resize(kField * kField);
    t.smooth.resize(kField * kField);
    for (float& value : t.white) value = static_cast<float>(random.normal());
    for (int y = 0; y < kField; ++y) {
      for (int x = 0; x < kField; ++x) {
        float sum = 0.0F;
        for (int k = 0; k < 9; ++k) {
          const int row = (y + k / 3) % kField, col = (x + k % 3) % kField;
          sum += t.white[row * kField + col];
        }
        t.smooth[y * kField + x] = sum / 3.0F;
      }
    }
    return t;
  }();
  return tables;
}

std::vector<float> encoding_table() {
  std::vector<float> table(65537);
  for (std::size_t i = 0; i < table.size(); ++i) {
    table[i] = 255.0F * std::pow(static_cast<float>(i) / 65536.0F, 1.0F / 2.2F);
  }
  return table;
}

// Marks the pixels of a row that a nearer surface hides from the projector, which stands to the
// right: seen from there, they lie at or beyond a place that something further right covers.
void mark_shadows(const float* depth, int width, float bf, std::vector<char>& shadow) {
  float nearest_column = 1e9F;
  for (int x = width - 1; x >= 0; --x) {
    shadow[x] = 0;
    if (depth[x] <= 0.0F) continue;
    const float column = static_cast<float>(x) - bf / depth[x];
    shadow[x] = column > nearest_column + 0.5F;
    nearest_column = std::min(nearest_column, column);
  }
}

bool at_depth_edge(const cv::Mat& depth, int x, int y) {
  const float z = depth.at<float>(y, x), limit = 0.06F * z;
  const auto differs = [&](int col, int row) {
    return col >= 0 && row >= 0 && col < depth.cols && row < depth.rows &&
           std::abs(depth.at<float>(row, col) - z) > limit;
  };
  return differs(x - 1, y) || differs(x + 1, y) || differs(x, y - 1) || differs(x, y + 1);
}

}  // namespace

cv::Mat develop_image(const cv::Mat& radiance, double gain, double noise, std::uint64_t seed) {
  static const std::vector<float> encoding = encoding_table();
  const NoiseTables& tables = noise_tables();
  const float sigma = static_cast<float>(1.5 * noise), scale = static_cast<float>(gain * 65536.0);
  cv::Mat image(radiance.size(), CV_8UC3);
  for (int y = 0; y < image.rows; ++y) {
    const float* in = radiance.ptr<float>(y);
    uchar* out = image.ptr<uchar>(y);
    const std::size_t start = mix_seed(seed, static_cast<std::uint64_t>(y));
    for (int i = 0; i < image.cols * 3; ++i) {
      const int index = std::min(static_cast<int>(in[i] * scale + 0.5F), 65536);
      out[i] = cv::saturate_cast<uchar>(encoding[index] +
                                        sigma * tables.white[(start + i) % (kField * kField)]);
    }
  }
  return image;
}

cv::Mat measure_depth(const Rendering& rendering, const Camera& camera, double strength,
                      std::uint64_t seed) {
  const NoiseTables& tables = noise_tables();
  Random random(seed);
  const int shift_x = random.integer(kField), shift_y = random.integer(kField);
  const float sigma = static_cast<float>(0.08 * strength);
  const float step = static_cast<float>(std::max(strength / 8.0, 1e-6));
  const float bf = static_cast<float>(kReferenceBf),
              factor = static_cast<float>(camera.depth_factor);
  const float farthest = static_cast<float>(
      std::min<double>(camera.max_depth, strength > 0.0 ? kFarthest : camera.max_depth));
  cv::Mat out(rendering.depth.size(), CV_32FC1);
  std::vector<char> shadow(static_cast<std::size_t>(out.cols), 0);
  for (int y = 0; y < out.rows; ++y) {
    const float* depth = rendering.depth.ptr<float>(y);
    const float* incidence = rendering.incidence.ptr<float>(y);
    if (strength > 0.0) {
      mark_shadows(depth, out.cols, static_cast<float>(camera.fx * camera.depth_baseline), shadow);
    }
    const std::size_t row = static_cast<std::size_t>((y + shift_y) % kField) * kField;
    for (int x = 0; x < out.cols; ++x) {
      float& reading = out.at<float>(y, x);
      reading = 0.0F;
      float z = depth[x];
      if (z <= 0.0F || z > farthest) continue;
      if (strength > 0.0) {
        const std::size_t column = static_cast<std::size_t>((x + shift_x) % kField);
        const float white = tables.white[row + column], smooth = tables.smooth[row + column];
        const float grazing = 0.17F + 0.02F * smooth;
        if (z < kNearest || shadow[x] || incidence[x] < grazing || white > 3.3F) continue;
        if (white > 0.2F && at_depth_edge(rendering.depth, x, y)) continue;
        const float disparity = bf / z + sigma * (0.8F * smooth + 0.6F * white);
        z = bf / std::max(std::round(disparity / step) * step, step);
        if (z > 1.3F * farthest) continue;
      }
      reading = std::round(z * factor) / factor;
    }
  }
  return out;
}

}  // namespace dxslam
