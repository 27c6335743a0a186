// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <string>

#include "base_maps.h"

namespace dxslam::fuzz {

enum class Outcome { kRefused, kUsed };

/// How far a spoiled map came.
struct TrialReport {
  Outcome outcome = Outcome::kRefused;
  bool localized = false;  ///< a frame at least
  bool tracked = false;    ///< while the map grew
  bool joined = false;     ///< fewer components than before, while the map grew
  int merged = 0;          ///< of the two orders
};

/// Makes a case's map, loads it and, unless it is refused, does all with it that programs do:
/// localization, mapping with loop closing and the final bundle, merging with a good map both ways,
/// saving and loading of what comes out, statistics and export. Throws a std::exception other than
/// InputError, or std::runtime_error, where that is not as promised.
TrialReport try_case(const BaseMaps& bases, std::uint64_t seed, std::uint64_t number,
                     const std::string& folder);

}  // namespace dxslam::fuzz
