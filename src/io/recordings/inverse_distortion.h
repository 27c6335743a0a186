// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <array>

#include "core/camera.h"

namespace dxslam {

/// Sets the distortion k1 k2 p1 p2 k3 of `camera`, which has a size and intrinsics, to the one
/// whose inverse is the same polynomial with `inverse` as coefficients: RealSense's "Inverse Brown
/// Conrady", which gives the ideal pixel by the raw one. Fitted over the image by least squares.
/// Returns the largest error of the fit in pixels.
double set_inverse_distortion(const std::array<double, 5>& inverse, Camera& camera);

}  // namespace dxslam
