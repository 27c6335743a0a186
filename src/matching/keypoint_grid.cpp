// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "matching/keypoint_grid.h"

#include <algorithm>
#include <cmath>

namespace dxslam {

KeypointGrid::KeypointGrid(const std::vector<Eigen::Vector2f>& pixels, float cell_size)
    : pixels_(&pixels), inverse_cell_(1.0F / cell_size) {
  Eigen::Vector2f top = Eigen::Vector2f::Zero();
  if (!pixels.empty()) origin_ = top = pixels.front();
  for (const Eigen::Vector2f& p : pixels) {
    origin_ = origin_.cwiseMin(p);
    top = top.cwiseMax(p);
  }
  columns_ = static_cast<int>((top.x() - origin_.x()) * inverse_cell_) + 1;
  rows_ = static_cast<int>((top.y() - origin_.y()) * inverse_cell_) + 1;
  starts_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  const auto cell_of = [&](const Eigen::Vector2f& p) {
    return static_cast<std::size_t>(clamp_row(p.y()) * columns_ + clamp_column(p.x()));
  };
  for (const Eigen::Vector2f& p : pixels) ++starts_[cell_of(p) + 1];
  for (std::size_t c = 1; c < starts_.size(); ++c) starts_[c] += starts_[c - 1];
  std::vector<int> next(starts_.begin(), starts_.end() - 1);
  indices_.resize(pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    indices_[static_cast<std::size_t>(next[cell_of(pixels[i])]++)] = static_cast<int>(i);
  }
}

int KeypointGrid::clamp_column(float x) const {
  const float c = std::floor((x - origin_.x()) * inverse_cell_);
  return static_cast<int>(std::clamp(c, 0.0F, static_cast<float>(columns_ - 1)));
}

int KeypointGrid::clamp_row(float y) const {
  const float r = std::floor((y - origin_.y()) * inverse_cell_);
  return static_cast<int>(std::clamp(r, 0.0F, static_cast<float>(rows_ - 1)));
}

}  // namespace dxslam
