// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "map/map.h"
#include "mapping/mapping_options.h"
#include "optimization/bundle_adjustment.h"

namespace dxslam {

/// A bundle problem cut out of the map, with the ids its numbers belong to.
struct LocalBundle {
  BundleProblem problem;
  std::vector<KeyframeId> keyframes;  ///< one per pose; the free ones first
  std::vector<PointId> points;        ///< one per point
  std::size_t free_keyframes = 0;
};

/// The keyframe and those that share most points with it are free, with all points they see; other
/// keyframes that see these points hold the border.
LocalBundle gather_local_bundle(const Map& map, KeyframeId keyframe, const MappingOptions& options);

/// All keyframes and points; the first keyframe of each component is held.
LocalBundle gather_full_bundle(const Map& map);
/// All keyframes and points of one component; its first keyframe is held.
LocalBundle gather_component_bundle(const Map& map, std::uint32_t component);

/// Writes the result back and unbinds the observations that failed their gate; returns how many.
int apply_local_bundle(const LocalBundle& bundle, const BundleReport& report, Map& map);

}  // namespace dxslam
