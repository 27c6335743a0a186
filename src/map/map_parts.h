// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "map/map.h"

namespace dxslam {

/// What a map is made of, with ids from 0 without gaps: for files, for putting maps together, and
/// as a snapshot that another thread may read, since frames are shared and never change.
/// Map(MapParts) makes a map of it again.
struct MapParts {
  Rig rig;  ///< of all frames
  /// By id. `points` and `covisibles` follow from the points' observations and are not looked at.
  std::vector<Keyframe> keyframes;
  std::vector<MapPoint> points;  ///< by id
  KeyframeId last_keyframe = kNoId;
};

/// Copies what lives in `map` and numbers it anew, in the same order: the new id of a keyframe is
/// its place in map.keyframe_ids(), that of a point its place in map.point_ids(), that of a
/// component its place among those left. A point made by a keyframe that was removed is taken as
/// made by that keyframe's anchor.
MapParts take_apart(const Map& map);

}  // namespace dxslam
