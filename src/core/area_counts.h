// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "core/camera.h"

namespace dxslam {

/// How many pixels lie in each of 8 x 6 areas of an image: whether things are spread over it.
class AreaCounts {
 public:
  static constexpr int kColumns = 8;
  static constexpr int kRows = 6;
  static constexpr std::size_t kAreas = 48;

  /// Of the pixels of a view, see Camera::view().
  explicit AreaCounts(const PixelBox& view) : view_(view) {}

  /// A pixel beyond the rim counts for the nearest area.
  void add(const Eigen::Vector2f& pixel);
  /// Of each area the smaller count of the two.
  AreaCounts limited_by(const AreaCounts& other) const;
  /// Areas that are not empty.
  int occupied() const;
  /// Of the areas that hold three or more, which are enough to tell, the share that is not empty in
  /// `found`; 0 if there is none.
  double share_in(const AreaCounts& found) const;

 private:
  PixelBox view_;
  std::array<int, kAreas> counts_{};
};

/// How much of an image agrees with a pose: of the areas in which the image has keypoints and the
/// map has points that should be in view, the share in which a keypoint agrees. Things that are
/// there twice agree in one part of the image, however many they are; a right pose agrees all over.
double agreeing_share(const PixelBox& view, const std::vector<Eigen::Vector2f>& keypoints,
                      const std::vector<Eigen::Vector2f>& in_view,
                      const std::vector<Eigen::Vector2f>& agreeing);

}  // namespace dxslam
