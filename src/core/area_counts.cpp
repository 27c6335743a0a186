// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/area_counts.h"

#include <algorithm>

namespace dxslam {
namespace {

constexpr int kEnough = 3;

}  // namespace

void AreaCounts::add(const Eigen::Vector2f& pixel) {
  ++counts_[view_.cell_of(pixel, kColumns, kRows)];
}

AreaCounts AreaCounts::limited_by(const AreaCounts& other) const {
  AreaCounts least = *this;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    least.counts_[i] = std::min(counts_[i], other.counts_[i]);
  }
  return least;
}

int AreaCounts::occupied() const {
  return static_cast<int>(
      std::count_if(counts_.begin(), counts_.end(), [](int count) { return count > 0; }));
}

double AreaCounts::share_in(const AreaCounts& found) const {
  int telling = 0;
  int covered = 0;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    if (counts_[i] < kEnough) continue;
    ++telling;
    if (found.counts_[i] > 0) ++covered;
  }
  return telling > 0 ? static_cast<double>(covered) / telling : 0.0;
}

double agreeing_share(const PixelBox& view, const std::vector<Eigen::Vector2f>& keypoints,
                      const std::vector<Eigen::Vector2f>& in_view,
                      const std::vector<Eigen::Vector2f>& agreeing) {
  const auto counts_of = [&](const std::vector<Eigen::Vector2f>& pixels) {
    AreaCounts counts(view);
    for (const Eigen::Vector2f& pixel : pixels) counts.add(pixel);
    return counts;
  };
  // An area with few keypoints or few points in view says nothing.
  return counts_of(in_view).limited_by(counts_of(keypoints)).share_in(counts_of(agreeing));
}

}  // namespace dxslam
