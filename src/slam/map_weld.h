// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>

#include "map_files/map_file.h"

namespace dxslam {

/// Looks for places that several components of the map show, and joins, fuses and adjusts them
/// where the loop closer accepts one (paper III.E, with the default options). The same map comes
/// out every time. Returns how many loops were closed; the map's loops then include them.
std::size_t weld_components(StoredMap& stored);

}  // namespace dxslam
