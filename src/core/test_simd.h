// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "core/simd.h"

namespace dxslam::testing_support {

/// The levels of this processor, the highest last: a test that sets one after the other
/// (set_simd_level()) leaves the highest behind.
inline std::vector<SimdLevel> simd_levels() {
  set_simd_level(SimdLevel::kAvx512);
  std::vector<SimdLevel> levels;
  for (const SimdLevel level : {SimdLevel::kPortable, SimdLevel::kAvx2, SimdLevel::kAvx512}) {
    if (level <= simd_level()) levels.push_back(level);
  }
  return levels;
}

}  // namespace dxslam::testing_support
