// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/split_mix.h"

namespace dxslam::fuzz {

/// Everything by chance in one case: follows from seed and number of the case alone.
class Chance {
 public:
  Chance(std::uint64_t seed, std::uint64_t number)
      : random_(SplitMix64::mixed(seed) ^ SplitMix64::mixed(number + 0x51ED)) {}

  /// Below `n`, which is at least 1.
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_.bits() % n); }
  bool one_in(std::size_t n) { return below(n) == 0; }
  double uniform() { return random_.uniform(); }
  std::uint64_t bits() { return random_.bits(); }

  /// Numbers that hurt: none, infinite, huge, tiny, at a bound; or `now` made a little or much
  /// different.
  double number(double now);
  float number(float now) { return static_cast<float>(number(static_cast<double>(now))); }
  /// Ids and counts that hurt, near `now`, near the count of what there is, or anything.
  std::uint32_t id(std::uint32_t now, std::size_t count);

 private:
  SplitMix64 random_;
};

}  // namespace dxslam::fuzz
