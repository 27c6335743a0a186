// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "matching/keypoint_grid.h"

#include <algorithm>
#include <cmath>

namespace dxslam {
namespace {

constexpr float kMostCells = 1024.0F;  // a side; what lies farther is in the last one

}  // namespace

KeypointGrid::KeypointGrid(const std::vector<Eigen::Vector2f>& pixels, float cell_size)
    : pixels_(&pixels), inverse_cell_(1.0F / cell_size) {
  std::vector<int> finite;
  finite.reserve(pixels.size());
  Eigen::Vector2f top = Eigen::Vector2f::Zero();
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Eigen::Vector2f& p = pixels[i];
    if (!p.allFinite()) continue;
    origin_ = finite.empty() ? p : origin_.cwiseMin(p);
    top = finite.empty() ? p : top.cwiseMax(p);
    finite.push_back(static_cast<int>(i));
  }
  const auto cells = [&](float extent) {
    return static_cast<int>(std::min(extent * inverse_cell_, kMostCells - 1.0F)) + 1;
  };
  columns_ = cells(top.x() - origin_.x());
  rows_ = cells(top.y() - origin_.y());
  starts_.assign(cell(0, rows_) + 1, 0);
  const auto cell_of = [&](const Eigen::Vector2f& p) {
    return cell(clamp_column(p.x()), clamp_row(p.y()));
  };
  const auto pixel = [&](int i) { return pixels[static_cast<std::size_t>(i)]; };
  for (const int i : finite) ++starts_[cell_of(pixel(i)) + 1];
  for (std::size_t c = 1; c < starts_.size(); ++c) starts_[c] += starts_[c - 1];
  std::vector<int> next(starts_.begin(), starts_.end() - 1);
  indices_.resize(finite.size());
  for (const int i : finite) {
    indices_[static_cast<std::size_t>(next[cell_of(pixel(i))]++)] = i;
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
