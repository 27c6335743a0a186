// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/camera.h"
#include "core/se3.h"

namespace dxslam {

/// Point seen at two undistorted pixels from two poses, by linear triangulation (DLT) refined by
/// one Gauss-Newton step. Nothing if it lies behind a camera or the rays are parallel within
/// `min_parallax` radians.
std::optional<Eigen::Vector3d> triangulate(const Camera& camera, const SE3& world_from_a,
                                           const Eigen::Vector2d& pixel_in_a,
                                           const SE3& world_from_b,
                                           const Eigen::Vector2d& pixel_in_b, double min_parallax);

}  // namespace dxslam
