// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

namespace dxslam {

// The inner loops are written once, in plain C++ that the compiler vectorises, and compiled for
// several instruction sets; the best that the processor has is chosen at run time. No file needs
// -march flags, which would change the alignment of Eigen's types.

enum class SimdLevel { kGeneric, kAvx2, kAvx512 };

/// The highest level of this processor.
SimdLevel simd_level();

}  // namespace dxslam

#if defined(__x86_64__) && defined(__GNUC__)
#define DXSLAM_HAS_X86_SIMD 1
#define DXSLAM_TARGET_AVX2 __attribute__((target("avx2,fma")))
#define DXSLAM_TARGET_AVX512 \
  __attribute__((target("avx512f,avx512bw,avx512dq,avx512vl,avx2,fma,prefer-vector-width=512")))
#endif
#define DXSLAM_INLINE_KERNEL __attribute__((always_inline)) inline
