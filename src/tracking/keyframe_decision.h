// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "core/frame.h"
#include "map/map_types.h"
#include "tracking/tracker_options.h"

namespace dxslam {

/// How the current frame stands against the reference keyframe.
struct KeyframeEvidence {
  int frames_since_keyframe = 0;
  int tracked_points = 0;    ///< map points matched in the frame
  int reference_points = 0;  ///< those the reference keyframe shares with others
  SE3 reference_from_camera;
};

/// Whether the frame shows so much that the map does not have that it should become a keyframe.
/// `points` is one a keypoint, kNoId where the map knows none.
bool is_keyframe_due(const KeyframeEvidence& evidence, const Frame& frame,
                     const std::vector<PointId>& points, const KeyframeOptions& options);

}  // namespace dxslam
