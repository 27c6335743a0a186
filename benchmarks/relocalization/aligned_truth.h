// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "core/se3.h"
#include "evaluation/association.h"

namespace dxslam::benchmark {

/// How far a pose is from the true one.
struct Deviation {
  double distance = 0.0;  ///< metres
  double angle = 0.0;     ///< degrees

  bool within(double max_distance, double max_angle) const {
    return distance <= max_distance && angle <= max_angle;
  }
};

Deviation deviation(const SE3& pose, const SE3& truth);

/// Where a map lies in the frame of the truth: truth = truth_from_map * pose * camera_from_true.
struct MapAlignment {
  SE3 truth_from_map;
  SE3 camera_from_true;  ///< identity where the truth is that of this very camera

  SE3 aligned(const SE3& pose) const { return truth_from_map * pose * camera_from_true; }
};

/// Rigid, fitted to positions and rotations, in least squares, each in units of what counts as
/// right. Positions alone would leave a turn about a straight path open.
MapAlignment align_poses(const std::vector<PosePair>& pairs, double unit_distance,
                         double unit_angle_degrees);

/// For a truth that belongs to another camera of the same device (7-Scenes: the poses are
/// those of the depth camera, the images those of the colour camera): the fixed offset of the two
/// is fitted as well, first its rotation to all rotations, then its translation to all positions.
MapAlignment align_with_camera_offset(const std::vector<PosePair>& pairs);

}  // namespace dxslam::benchmark
