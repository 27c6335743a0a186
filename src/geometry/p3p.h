// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/se3.h"

namespace dxslam {

/// Up to four camera poses; plain memory, so that a RANSAC loop allocates nothing.
struct P3pSolutions {
  std::array<SE3, 4> camera_from_world;
  int count = 0;
};

/// Whether three points span a plane, well above rounding. False if one is not finite.
bool spans_plane(const std::array<Eigen::Vector3d, 3>& points);

/// All poses from which three world points appear along three rays (camera frame, any length, z may
/// have any sign). The distances come from one degenerate conic of the pencil that the law of
/// cosines spans (Persson and Nordberg, Lambda Twist, 2018), polished by Newton steps. No solution
/// for points in a line, equal rays or values that are not finite.
P3pSolutions solve_p3p(const std::array<Eigen::Vector3d, 3>& points_in_world,
                       const std::array<Eigen::Vector3d, 3>& rays);

/// The motion that takes triangle `source` to triangle `target`, exact where the two are congruent;
/// else the first corners, first edges and planes are made to agree. Both must span a plane.
SE3 align_triangles(const std::array<Eigen::Vector3d, 3>& source,
                    const std::array<Eigen::Vector3d, 3>& target);

}  // namespace dxslam
