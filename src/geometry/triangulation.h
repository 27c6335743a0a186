// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/camera.h"
#include "core/se3.h"

namespace dxslam {

/// A point as a camera sees it. Refers to what it is made of.
struct PixelView {
  const Camera& camera;
  const SE3& world_from_camera;
  const Eigen::Vector2d& pixel;  ///< undistorted
};

/// Point seen in two views, by linear triangulation (DLT) refined by one Gauss-Newton step. Nothing
/// if it lies behind a camera or the rays are parallel within `min_parallax` radians.
std::optional<Eigen::Vector3d> triangulate(const PixelView& a, const PixelView& b,
                                           double min_parallax);

}  // namespace dxslam
