// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include "synthetic/layout.h"
#include "synthetic/random.h"

namespace dxslam {

struct FurnishOptions {
  Eigen::Vector2d area_min, area_max;  ///< floor area that things must stay in, metres
  double max_depth = 0.9;              ///< metres that things may stand off the wall
  bool windows = false;
  bool closed_doors = false;
};

/// Puts furniture along a wall and pictures on it, clear of its openings and of the path.
void furnish_wall(Layout& layout, const Wall& wall, const FurnishOptions& options, Random& random);

/// A table with a rug around the given place.
void add_centre_piece(Layout& layout, const Eigen::Vector2d& centre, Random& random);

}  // namespace dxslam
