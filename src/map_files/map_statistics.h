// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <vector>

#include "map_files/map_file.h"

namespace dxslam {

/// Size of one component.
struct ComponentSize {
  std::size_t keyframes = 0;
  std::size_t points = 0;
  double first_stamp = 0.0, last_stamp = 0.0;  ///< seconds
  double extent = 0.0;                         ///< metres; diagonal of the box around its keyframes
};

/// How large a map is, and how well its parts fit each other.
struct MapStatistics {
  std::vector<ComponentSize> components;
  std::size_t keypoints = 0;
  std::size_t observations = 0;
  std::size_t globals = 0;  ///< keyframes with a global descriptor
  /// Distance of observations from where the keyframe should see the point, pixels.
  double median_error = 0.0;
  double p95_error = 0.0;
  std::size_t behind = 0;  ///< observations of points that lie behind the keyframe's camera
  /// Groups of keyframes that share points, one for each component in a map that hangs together.
  std::size_t covisible_groups = 0;
  std::size_t blind_keyframes = 0;  ///< that see no point
};

MapStatistics map_statistics(const StoredMap& stored);

}  // namespace dxslam
