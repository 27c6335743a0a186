// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <algorithm>
#include <opencv2/core.hpp>

namespace dxslam {

/// Offset of the top of the parabola through three neighbouring values, the middle one the highest
/// or nearly; within half a pixel; 0 where the values do not bend downwards.
inline float parabola_offset(float before, float middle, float after) {
  const float curvature = before - 2.0F * middle + after;
  if (!(curvature < -1e-6F)) return 0.0F;
  return std::clamp(0.5F * (before - after) / curvature, -0.5F, 0.5F);
}

/// Sub-pixel offset of a score peak, by a parabola along x and one along y. `value(x, y)` is best a
/// logarithm of the score: a Gaussian peak is then a parabola exactly. All four direct neighbours
/// of (x, y) must exist.
template <class Value>
cv::Point2f peak_offset(const Value& value, int x, int y) {
  const float middle = value(x, y);
  return {parabola_offset(value(x - 1, y), middle, value(x + 1, y)),
          parabola_offset(value(x, y - 1), middle, value(x, y + 1))};
}

}  // namespace dxslam
