// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/simd.h"

#include <algorithm>
#include <atomic>

namespace dxslam {
namespace {

#ifdef __SANITIZE_ADDRESS__
// AddressSanitizer moves frames of the stack to the heap, to find uses after the return. GCC 12
// aligns them to 32 bytes there, but accesses AVX-512 registers in them as if aligned to 64.
constexpr bool kMayUseAvx512 = false;
#else
constexpr bool kMayUseAvx512 = true;
#endif

SimdLevel level_of_processor() {
#ifdef DXSLAM_HAS_X86_SIMD
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
      __builtin_cpu_supports("popcnt")) {
    const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
    return wide && kMayUseAvx512 ? SimdLevel::kAvx512 : SimdLevel::kAvx2;
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
