// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "core/simd.h"

namespace dxslam {

/// Hamming distance of two binary descriptors: a kernel, or a part of one.
DXSLAM_INLINE_KERNEL int count_differing_bits(const std::uint8_t* a, const std::uint8_t* b,
                                              std::size_t bytes) {
  int bits = 0;
  std::size_t k = 0;
  for (; k + 8 <= bytes; k += 8) {
    std::uint64_t x = 0;
    std::uint64_t y = 0;
    std::memcpy(&x, a + k, 8);
    std::memcpy(&y, b + k, 8);
    bits += __builtin_popcountll(x ^ y);
  }
  for (; k < bytes; ++k) bits += __builtin_popcount(static_cast<unsigned>(a[k] ^ b[k]));
  return bits;
}

}  // namespace dxslam
