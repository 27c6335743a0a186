// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <array>

#include "core/se3.h"

namespace dxslam {

/// A pose as plain numbers and back, to the bit: the quaternion x y z w, then the translation.
using PoseNumbers = std::array<double, 7>;

inline PoseNumbers numbers_of(const SE3& pose) {
  const auto& q = pose.rotation().coeffs();
  const auto& t = pose.translation();
  return {q[0], q[1], q[2], q[3], t[0], t[1], t[2]};
}

inline SE3 pose_of(const PoseNumbers& n) {
  return SE3::of_unit({n[3], n[0], n[1], n[2]}, {n[4], n[5], n[6]});
}

}  // namespace dxslam
