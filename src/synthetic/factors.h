// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include "synthetic/layout.h"
#include "synthetic/synthetic_options.h"

namespace dxslam {

/// Viewpoint: shifts and turns the path.
PathOptions path_with_factors(PathOptions path, const FactorOptions& factors);

/// Illumination and changed objects: edits lamps and things, never walls or the path. Things that
/// were moved keep clear of the path and of each other.
void apply_factors(Layout& layout, const FactorOptions& factors);

/// Exposure drift: gain of the image at a time.
double exposure_gain(const FactorOptions& factors, double time);

}  // namespace dxslam
