// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/simd.h"

#include <algorithm>
#include <atomic>

namespace dxslam {
namespace {

SimdLevel level_of_processor() {
#ifdef DXSLAM_HAS_X86_SIMD
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
      __builtin_cpu_supports("popcnt")) {
    const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
    return wide ? SimdLevel::kAvx512 : SimdLevel::kAvx2;
  }
#endif
  return SimdLevel::kPortable;
}

// Zero, the portable level, until it is initialised.
std::atomic<SimdLevel> level_in_use{level_of_processor()};

}  // namespace

SimdLevel simd_level() { return level_in_use.load(std::memory_order_relaxed); }

void set_simd_level(SimdLevel level) {
  level_in_use.store(std::min(level, level_of_processor()), std::memory_order_relaxed);
}

}  // namespace dxslam
