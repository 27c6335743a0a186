// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include "core/se3.h"

namespace dxslam {

/// Whether a camera can move by `motion`, the pose of one frame in another's, within `seconds`.
/// `limits` has max_speed (m/s), max_turn (degrees/s), and distance_slack (m) and angle_slack
/// (degrees) for the errors of both poses.
template <class Limits>
bool is_within_reach(const Limits& limits, const SE3& motion, double seconds) {
  constexpr double kDegrees = 0.017453292519943295;  // in radians; C++17 has no pi
  return motion.translation().norm() <= limits.distance_slack + limits.max_speed * seconds &&
         rotation_angle(motion, SE3()) <=
             (limits.angle_slack + limits.max_turn * seconds) * kDegrees;
}

}  // namespace dxslam
