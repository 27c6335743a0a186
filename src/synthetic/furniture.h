// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include "synthetic/layout.h"
#include "synthetic/surface_builder.h"

namespace dxslam {

/// Builds one thing of the layout as number `object`.
void build_placement(SurfaceBuilder& builder, const Placement& placement, int object);

}  // namespace dxslam
