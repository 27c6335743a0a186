// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "features/network/tensor_view.h"
#include "features/post_processing/candidate.h"

namespace dxslam {

/// Detect-and-describe without a score map, as in D2-Net: a place of the descriptor map is a
/// candidate if its strongest channel is also a maximum of that channel among its eight
/// neighbours, and the channel bends downwards there about equally in all directions (no edge). The
/// score, 0 to 1, is the share of the channel among the 3x3 places by softmax; candidates above
/// `threshold` are appended at the pixel of the input nearest to the middle of the place.
void find_descriptor_maxima(const TensorView& map, int stride, double threshold,
                            std::vector<Candidate>& candidates);

}  // namespace dxslam
