// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "features/candidate.h"
#include "features/tensor_view.h"

namespace dxslam {

/// Appends the pixels of a full-resolution score map (one channel, column_stride 1) inside `area`
/// whose value is above `threshold`. With `maxima_only` those that a direct horizontal or vertical
/// neighbour beats are left out: enough, and much quicker, where non-maximum suppression with a
/// radius of at least 1 and no further iterations follows.
void find_candidates(const TensorView& scores, float threshold, const PixelArea& area,
                     bool maxima_only, std::vector<Candidate>& candidates);

}  // namespace dxslam
