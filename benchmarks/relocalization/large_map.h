// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>

#include "map/map.h"

namespace dxslam::benchmark {

/// A map of at least `keyframes` keyframes: `map` as it is, ids apart, and copies of it, each a
/// component of its own whose descriptors are shuffled and whose global descriptors are blurred
/// with noise: places that look somewhat alike, but of which no point matches.
Map enlarge_map(const Map& map, std::size_t keyframes);

}  // namespace dxslam::benchmark
