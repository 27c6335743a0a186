// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "vocabulary/checksum.h"

#include <array>
#include <cstddef>
#include <cstring>

namespace dxslam {

// Two running sums in each of eight lanes: the second one also notices what only changed places.
std::uint64_t fast_checksum(std::string_view bytes) {
  constexpr std::size_t kLanes = 8;
  std::array<std::uint64_t, kLanes> first{};
  std::array<std::uint64_t, kLanes> second{};
  std::array<std::uint64_t, kLanes> words{};
  std::size_t at = 0;
  for (; at + sizeof(words) <= bytes.size(); at += sizeof(words)) {
    std::memcpy(words.data(), bytes.data() + at, sizeof(words));
    for (std::size_t i = 0; i < kLanes; ++i) {
      first[i] += words[i];
      second[i] += first[i];
    }
  }
  words.fill(0);
  std::memcpy(words.data(), bytes.data() + at, bytes.size() - at);
  std::uint64_t hash = bytes.size();
  for (std::size_t i = 0; i < kLanes; ++i) {
    for (const std::uint64_t part : {words[i], first[i], second[i]}) {
      hash = (hash ^ part) * 0x9e3779b97f4a7c15U;
      hash ^= hash >> 29U;
    }
  }
  return hash;
}

}  // namespace dxslam
