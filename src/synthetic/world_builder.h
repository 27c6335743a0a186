// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>

#include "synthetic/layout.h"
#include "synthetic/world.h"

namespace dxslam {

/// Builds walls, things and lamps, paints all textures and bakes the light. The seed decides the
/// pictures; the layout decides everything else. Independent of the number of threads.
World build_world(const Layout& layout, std::uint64_t seed, int threads);

}  // namespace dxslam
