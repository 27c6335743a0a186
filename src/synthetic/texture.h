// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace dxslam {

/// A picture with its mip chain, filtered trilinearly and anisotropically. Immutable once made, so
/// any number of threads may sample it.
class Texture {
 public:
  Texture() = default;
  /// `image` is CV_8UC3 (BGR, gamma encoded), both sides powers of two; else ContractError.
  explicit Texture(const cv::Mat& image);

  /// Filtered colour (BGR, 0 to 255, gamma encoded) at texture coordinates (u, v), where 1 is the
  /// whole picture. (du_dx, dv_dx) and (du_dy, dv_dy) are the steps to the next pixel. Wraps around
  /// where `tiled`, else the border is repeated.
  void sample(float u, float v, float du_dx, float dv_dx, float du_dy, float dv_dy, bool tiled,
              float bgr[3]) const;

  int width() const { return levels_.empty() ? 0 : levels_[0].width; }
  int height() const { return levels_.empty() ? 0 : levels_[0].height; }
  /// Mean colour of the picture.
  cv::Vec3f mean() const;

 private:
  struct Level {
    int width = 0, height = 0;
    std::vector<std::uint32_t> texels;  // B | G << 8 | R << 16
  };
  static inline std::uint64_t bilinear(const Level& level, float u, float v, bool tiled);
  std::vector<Level> levels_;
};

}  // namespace dxslam
