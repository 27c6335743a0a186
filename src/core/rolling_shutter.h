// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include "core/camera.h"
#include "core/frame.h"
#include "core/se3.h"

namespace dxslam {

/// `raw` as a camera that takes all rows at the same time, that of the middle row, would have seen
/// it. A rolling shutter takes row y at (y / height - 1/2) * Camera::readout_time, and meanwhile
/// the camera moves on: at 80 degrees per second and 30 ms, keypoints of the first and the last row
/// lie 22 pixels apart from where the same pose puts them. Keypoints with depth are moved by the
/// whole motion and their depth with them, others by the rotation alone; descriptors are shared.
///
/// `velocity` is (rho, phi) per second in the camera's frame: world_from_camera(t + s) =
/// world_from_camera(t) * SE3::exp(s * velocity).
FramePtr without_rolling_shutter(const FramePtr& raw, const Camera& camera,
                                 const Vector6d& velocity);

}  // namespace dxslam
