// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "synthetic/world.h"

namespace dxslam {

/// Computes the light grid of every surface: lamps with falloff and shadows, ambient light dimmed
/// in corners. Independent of the number of threads.
void bake_light(World& world, int threads);

/// Light of surfaces that move: lamps without shadows, at the corners only.
void light_without_shadows(const World& world, std::vector<Surface>& surfaces);

/// Sets the exposure so that the mean of light times texture over the building (not the things in
/// it) becomes `level` (linear, 1 saturates).
void expose_for(World& world, double level);

}  // namespace dxslam
