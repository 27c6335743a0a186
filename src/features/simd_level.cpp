// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/simd_level.h"

namespace dxslam {

SimdLevel simd_level() {
#ifdef DXSLAM_HAS_X86_SIMD
  static const SimdLevel kLevel = [] {
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) {
      return SimdLevel::kAvx512;
    }
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return SimdLevel::kAvx2;
    return SimdLevel::kGeneric;
  }();
  return kLevel;
#else
  return SimdLevel::kGeneric;
#endif
}

}  // namespace dxslam
