// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

/// Before a function: one source, several instruction sets; the loader picks the best the CPU has
/// (ifunc). Sanitizers start before ifuncs are resolved, so their builds take the portable version.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && \
    defined(__GNUC__) && !defined(__clang__)
#define DXSLAM_SIMD __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define DXSLAM_SIMD
#endif

namespace dxslam {

/// Numbers that are worked on at once, wherever they lie in memory: one AVX-512 register, two of
/// AVX2, four of SSE. Keep them inside functions: how they are passed depends on the instruction
/// set.
constexpr int kSimdLanes = 16;
using FloatLanes =
    float __attribute__((vector_size(kSimdLanes * sizeof(float)), aligned(4), may_alias));
using IntLanes = int __attribute__((vector_size(kSimdLanes * sizeof(int)), aligned(4), may_alias));

}  // namespace dxslam
