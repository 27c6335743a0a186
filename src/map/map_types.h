// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/frame.h"
#include "core/se3.h"

namespace dxslam {

// Ids rise. That of a keyframe is given once. That of a removed point comes again after 2^32
// others: days later, when nobody remembers the point.
using KeyframeId = std::uint32_t;
using PointId = std::uint32_t;
inline constexpr std::uint32_t kNoId = 0xFFFFFFFFU;

/// Keypoint `keypoint` of keyframe `keyframe` is an image of the point.
struct PointObservation {
  KeyframeId keyframe = kNoId;
  std::uint32_t keypoint = 0;
};

/// A point of the scene. Its descriptor is that of one of its observations.
struct MapPoint {
  PointId id = kNoId;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in world, metres
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< mean unit direction from point to cameras
  float distance = 0.0F;  ///< median distance to the cameras that see it, metres
  KeyframeId created_by = kNoId;
  std::uint32_t visible = 0;                   ///< frames in which it should have been seen
  std::uint32_t found = 0;                     ///< frames in which it was matched
  std::vector<PointObservation> observations;  ///< by rising keyframe, one per keyframe
  std::uint32_t descriptor = 0;                ///< index into observations
};

/// Keyframes that see the same points: `shared` is how many.
struct Covisible {
  KeyframeId keyframe = kNoId;
  int shared = 0;
};

struct Keyframe {
  KeyframeId id = kNoId;
  FramePtr frame;
  SE3 world_from_camera;
  std::vector<PointId> points;        ///< one per keypoint; kNoId where there is none
  std::vector<Covisible> covisibles;  ///< by rising keyframe id
  KeyframeId parent = kNoId;          ///< in the spanning tree; kNoId for a component's first
  /// Keyframes of different components have no known pose relative to one another: each has a
  /// world of its own (several maps, until a place is recognised and they are joined).
  std::uint32_t component = 0;
};

}  // namespace dxslam
