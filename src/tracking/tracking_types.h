// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <vector>

#include "map/map_types.h"

namespace dxslam {

enum class TrackingState { kNotStarted, kTracking, kLost };

/// What tracking found for one frame. The pose hangs on a keyframe, so that it stays right when
/// mapping moves the keyframe later.
struct TrackedFrame {
  std::int64_t index = 0;
  double stamp = 0.0;
  TrackingState state = TrackingState::kNotStarted;
  SE3 world_from_camera;  ///< as known when the frame was tracked
  /// Of the map, in whose world the pose is; kNoId for the frame that begins a new one.
  std::uint32_t component = kNoId;
  KeyframeId reference = kNoId;
  SE3 reference_from_camera;
  int keypoints = 0;
  int keypoints_with_depth = 0;  ///< not counted for frames that a map's place was sought for
  int inliers = 0;               ///< map points that agree with the pose
  bool is_keyframe = false;      ///< mapping was asked to make it one
  bool recovered = false;        ///< found by descriptors alone, without a predicted pose
  double rms_pixels = 0.0;       ///< of the inliers
};

/// Why a frame has no pose.
enum class LossReason {
  kFewKeypoints,  ///< it shows too few keypoints: a covered lens, a bare wall, darkness
  kFewDepths,     ///< too few of its keypoints have a depth: no map can begin with it
  kFewMatches,    ///< too few known points were found in it
  kNoAgreement,   ///< enough were found, but too few of them agree on one pose
  kDisbelieved,   ///< a pose was found by descriptors alone, too weak for where it is (recovery.h)
  kPlaceUnknown,  ///< it was looked for in the whole map, and not found
};
const char* describe(LossReason reason);

/// In how many frames a point should have been seen and was matched, since the last report.
struct PointCount {
  PointId point = kNoId;
  std::uint32_t visible = 0;
  std::uint32_t found = 0;
};

/// Message from tracking to mapping: make this frame a keyframe.
struct KeyframeRequest {
  FramePtr frame;
  KeyframeId reference = kNoId;  ///< kNoId: this is the first keyframe, at the origin
  SE3 reference_from_camera;
  std::vector<PointId> points;  ///< one per keypoint; kNoId: none
  std::vector<PointCount> counts;
};

}  // namespace dxslam
