// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <vector>

#include "map/map.h"

namespace dxslam {

/// A place as the map knows it: a keyframe and those that share most points with it.
struct KeyframeGroup {
  std::vector<KeyframeId> keyframes;  ///< the keyframe itself first
  std::vector<PointId> points;        ///< that any of them sees, its own first; no point twice
};

/// At most `keyframes` keyframes, of which the others share at least `min_shared` points with the
/// first, and at most `max_points` points.
KeyframeGroup gather_group(const Map& map, KeyframeId keyframe, std::size_t keyframes,
                           int min_shared, std::size_t max_points);

}  // namespace dxslam
