// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "vocabulary/word_search.h"

#include <algorithm>
#include <limits>

#include "core/simd.h"
#include "matching/differing_bits.h"

namespace dxslam {
namespace {

constexpr int kGroup = 8;          // descents side by side, so that memory is waited for together
constexpr std::size_t kLine = 64;  // bytes of a cache line

struct FloatDistance {
  using Value = float;
  DXSLAM_INLINE_KERNEL static float of(const std::uint8_t* a_bytes, const std::uint8_t* b_bytes,
                                       std::size_t dimension) {
    const auto* a = reinterpret_cast<const float*>(a_bytes);
    const auto* b = reinterpret_cast<const float*>(b_bytes);
    FloatLanes sum = {};
    std::size_t d = 0;
    for (; d + kSimdLanes <= dimension; d += kSimdLanes) {
      const FloatLanes difference =
          *reinterpret_cast<const FloatLanes*>(a + d) - *reinterpret_cast<const FloatLanes*>(b + d);
      sum += difference * difference;
    }
    float part[kSimdLanes];
    std::memcpy(part, &sum, sizeof(part));
    for (std::size_t half = kSimdLanes / 2; half > 0; half /= 2) {
      for (std::size_t i = 0; i < half; ++i) part[i] += part[i + half];
    }
    float total = part[0];
    for (; d < dimension; ++d) total += (a[d] - b[d]) * (a[d] - b[d]);
    return total;
  }
};

struct BitDistance {
  using Value = int;
  DXSLAM_INLINE_KERNEL static int of(const std::uint8_t* a, const std::uint8_t* b,
                                     std::size_t bytes) {
    return count_differing_bits(a, b, bytes);
  }
};

template <class Distance>
DXSLAM_INLINE_KERNEL std::uint32_t nearest_child(const FbowImage& image, const std::uint8_t* block,
                                                 const std::uint8_t* descriptor) {
  const std::size_t dimension = image.layout.dimension();
  const std::uint32_t count = FbowImage::child_count(block);
  const std::uint8_t* candidate = image.descriptor(block, 0);
  std::uint32_t nearest = 0;
  auto least = std::numeric_limits<typename Distance::Value>::max();
  for (std::uint32_t i = 0; i < count; ++i, candidate += image.layout.descriptor_step) {
    const auto distance = Distance::of(descriptor, candidate, dimension);
    if (distance < least) {
      least = distance;
      nearest = i;
    }
  }
  return nearest;
}

DXSLAM_INLINE_KERNEL void fetch_block(const FbowImage& image, const std::uint8_t* block) {
  constexpr std::size_t kMost = 64 * kLine;
  const std::size_t bytes = std::min(image.layout.block_step, kMost);
  for (std::size_t at = 0; at < bytes; at += kLine) __builtin_prefetch(block + at);
}

template <class Distance>
DXSLAM_INLINE_KERNEL void descend_group(const FbowImage& image, const std::uint8_t* const* rows,
                                        int count, FbowImage::Child* found) {
  const std::uint8_t* block[kGroup];
  for (int r = 0; r < count; ++r) block[r] = image.block(0);
  int left = count;
  while (left > 0) {
    for (int r = 0; r < count; ++r) {
      if (block[r] == nullptr) continue;
      const std::uint32_t nearest = nearest_child<Distance>(image, block[r], rows[r]);
      found[r] = image.child(block[r], nearest);
      if (found[r].is_word()) {
        block[r] = nullptr;
        --left;
      } else {
        block[r] = image.block(found[r].index());
        fetch_block(image, block[r]);
      }
    }
  }
}

}  // namespace

void search_words(const FbowImage& image, const cv::Mat& descriptors, FbowImage::Child* found) {
  const auto descend = image.layout.binary ? simd_kernel<descend_group<BitDistance>>()
                                           : simd_kernel<descend_group<FloatDistance>>();
  for (int i = 0; i < descriptors.rows; i += kGroup) {
    const int count = std::min(kGroup, descriptors.rows - i);
    const std::uint8_t* rows[kGroup];
    for (int r = 0; r < count; ++r) rows[r] = descriptors.ptr(i + r);
    descend(image, rows, count, found + i);
  }
}

}  // namespace dxslam
