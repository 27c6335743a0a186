// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include "core/frame.h"
#include "map/map_types.h"
#include "tracking/tracker_options.h"

namespace dxslam {

/// How the current frame stands against the reference keyframe.
struct KeyframeEvidence {
  int frames_since_keyframe = 0;
  int tracked_points = 0;       ///< map points matched in the frame
  int best_tracked_points = 0;  ///< most of any frame since the last keyframe
  SE3 reference_from_camera;
};

/// Whether the frame has moved or lost so much of what the reference keyframe shows that it should
/// become a keyframe. Tracked points are judged against what was reached since the last keyframe,
/// not against a fixed number: how many keypoints come again depends on the light.
bool is_keyframe_due(const KeyframeEvidence& evidence, const Frame& frame,
                     const KeyframeOptions& options);

}  // namespace dxslam
