// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "features/network/tensor_view.h"
#include "features/post_processing/candidate.h"

namespace dxslam {

/// Appends the pixels of a full-resolution score map (one channel, column_stride 1) whose value is
/// above `threshold`.
void find_candidates(const TensorView& scores, float threshold, std::vector<Candidate>& candidates);

/// Of these only the maxima of squares of side 2 * radius + 1 (radius > 0) that lie in `area`,
/// which keeps off the rim of the map by a pixel at least: the result of find_candidates() followed
/// by NonMaximumSuppression without further passes, read off the map itself and so much quicker.
void find_maxima(const TensorView& scores, float threshold, const PixelArea& area, int radius,
                 std::vector<Candidate>& candidates);

}  // namespace dxslam
