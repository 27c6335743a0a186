// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <opencv2/core.hpp>

#include "synthetic/patterns.h"
#include "synthetic/random.h"

namespace dxslam {

/// Walls, floors, ceilings and cloth, made to repeat; both sides of `size` are at least 256.
/// An empty image if the pattern is no material.
cv::Mat paint_material(Pattern pattern, Random& random, cv::Size size);

}  // namespace dxslam
