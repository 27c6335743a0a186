// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>

namespace dxslam {

/// Counts over everything mapping did.
struct MappingTotals {
  std::int64_t keyframes = 0;
  std::int64_t new_points = 0;
  std::int64_t triangulated_points = 0;
  std::int64_t fused_points = 0;
  std::int64_t culled_points = 0;
  std::int64_t culled_keyframes = 0;
  std::int64_t bundle_keyframes = 0;  ///< moved by local bundle adjustment, summed over keyframes
  std::int64_t bundle_observations = 0;   ///< in it
  std::int64_t outlier_observations = 0;  ///< unbound by it
  std::int64_t dropped_requests = 0;      ///< since mapping was busy (real time only)
};

}  // namespace dxslam
