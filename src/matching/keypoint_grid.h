// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <vector>

namespace dxslam {

/// Buckets of keypoints for radius queries. Holds indices only; the pixels it was built from must
/// outlive it. A pixel that is not finite is never found. Immutable, safe to share between threads.
class KeypointGrid {
 public:
  explicit KeypointGrid(const std::vector<Eigen::Vector2f>& pixels, float cell_size = 16.0F);

  /// Calls visit(index) for every keypoint within `radius` pixels of `center`, in an order that
  /// depends on the keypoints alone.
  template <class Visitor>
  void for_each_within(const Eigen::Vector2f& center, float radius, Visitor&& visit) const {
    if (!center.allFinite()) return;
    const int x0 = clamp_column(center.x() - radius), x1 = clamp_column(center.x() + radius);
    const int y0 = clamp_row(center.y() - radius), y1 = clamp_row(center.y() + radius);
    for (int y = y0; y <= y1; ++y) {
      const std::size_t first = cell(x0, y);
      const std::size_t last = cell(x1, y) + 1;
      for (int k = starts_[first]; k < starts_[last]; ++k) {
        const int index = indices_[static_cast<std::size_t>(k)];
        const Eigen::Vector2f d = (*pixels_)[static_cast<std::size_t>(index)] - center;
        if (d.squaredNorm() <= radius * radius) visit(index);
      }
    }
  }

 private:
  std::size_t cell(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  int clamp_column(float x) const;
  int clamp_row(float y) const;

  const std::vector<Eigen::Vector2f>* pixels_;
  Eigen::Vector2f origin_ = Eigen::Vector2f::Zero();
  float inverse_cell_ = 1.0F;
  int columns_ = 1;
  int rows_ = 1;
  std::vector<int> starts_;   // first entry of each cell in indices_, and one past the last
  std::vector<int> indices_;  // by cell, then by index
};

}  // namespace dxslam
