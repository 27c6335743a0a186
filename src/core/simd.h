// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

namespace dxslam {

// Inner loops are written once, as DXSLAM_INLINE_KERNEL functions in plain C++ that the compiler
// vectorises, and simd_kernel() compiles each for several instruction sets; the best that the
// processor has is chosen at run time. No file needs -march flags, which would change the alignment
// of Eigen's types.

enum class SimdLevel { kPortable, kAvx2, kAvx512 };

/// The level in use: the highest of this processor, unless a test has lowered it.
SimdLevel simd_level();

/// For tests: all kernels run at this level from now on, or at the processor's if that is lower.
/// Not while another thread works.
void set_simd_level(SimdLevel level);

/// Numbers that are worked on at once, wherever they lie in memory: one AVX-512 register, two of
/// AVX2, four of SSE. Keep them inside kernels: how they are passed depends on the instruction set.
constexpr int kSimdLanes = 16;
using FloatLanes =
    float __attribute__((vector_size(kSimdLanes * sizeof(float)), aligned(4), may_alias));
using IntLanes = int __attribute__((vector_size(kSimdLanes * sizeof(int)), aligned(4), may_alias));

/// Before a kernel: it becomes part of each of its variants and so uses their instructions.
#define DXSLAM_INLINE_KERNEL __attribute__((always_inline)) inline

#if defined(__x86_64__) && defined(__GNUC__)
#define DXSLAM_HAS_X86_SIMD 1
#define DXSLAM_TARGET_AVX2 __attribute__((target("avx2,fma,popcnt")))
#define DXSLAM_TARGET_AVX512                                       \
  __attribute__((                                                  \
      target("avx512f,avx512bw,avx512dq,avx512vl,avx2,fma,popcnt," \
             "prefer-vector-width=512")))
#endif

/// One kernel compiled for each level.
template <auto Kernel>
struct SimdVariants;
template <class Result, class... Arguments, Result (*Kernel)(Arguments...)>
struct SimdVariants<Kernel> {
  static Result portable(Arguments... arguments) { return Kernel(arguments...); }
#ifdef DXSLAM_HAS_X86_SIMD
  DXSLAM_TARGET_AVX2 static Result avx2(Arguments... arguments) { return Kernel(arguments...); }
  DXSLAM_TARGET_AVX512 static Result avx512(Arguments... arguments) { return Kernel(arguments...); }
#endif
};

/// The variant of a kernel for the level in use: `simd_kernel<dot>()(a, b, dimension)`.
template <auto Kernel>
auto simd_kernel() -> decltype(Kernel) {
#ifdef DXSLAM_HAS_X86_SIMD
  const SimdLevel level = simd_level();
  if (level == SimdLevel::kAvx512) return SimdVariants<Kernel>::avx512;
  if (level == SimdLevel::kAvx2) return SimdVariants<Kernel>::avx2;
#endif
  return SimdVariants<Kernel>::portable;
}

}  // namespace dxslam
