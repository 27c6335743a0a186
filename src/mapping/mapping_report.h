// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "map/map_types.h"

namespace dxslam {

/// What one keyframe changed.
struct MappingReport {
  KeyframeId keyframe = kNoId;
  int new_points = 0;
  int triangulated_points = 0;
  int fused_points = 0;
  int culled_points = 0;
  std::vector<KeyframeId> culled_keyframes;
  int bundle_keyframes = 0;
  int bundle_points = 0;
  int bundle_observations = 0;
  int outlier_observations = 0;
};

}  // namespace dxslam
