// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "core/se3.h"

namespace dxslam {

/// Pose of a sensor at a time.
struct StampedPose {
  double stamp = 0.0;  ///< seconds
  SE3 world_from_camera;
};

/// Poses by rising stamp.
using Trajectory = std::vector<StampedPose>;

}  // namespace dxslam
