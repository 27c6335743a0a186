// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cmath>
#include <cstdint>

#include "core/split_mix.h"

namespace dxslam {

/// One 64-bit hash of two; gives independent seeds to the parts of a world, so that a change in one
/// part never shifts the random numbers of another.
inline std::uint64_t mix_seed(std::uint64_t a, std::uint64_t b) {
  return SplitMix64::mixed(a * 0x9E3779B97F4A7C15ULL + b + 0x632BE59BD9B4E019ULL);
}

/// Random numbers of several distributions, the same with every standard library.
class Random : public SplitMix64 {
 public:
  using SplitMix64::SplitMix64;
  using SplitMix64::uniform;

  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// In [0, count); count must be positive.
  int integer(int count) { return static_cast<int>(uniform() * count); }
  int integer(int low, int high) { return low + integer(high - low + 1); }
  bool chance(double probability) { return uniform() < probability; }
  /// Standard normal (Box-Muller).
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(6.283185307179586 * uniform());
  }
};

}  // namespace dxslam
