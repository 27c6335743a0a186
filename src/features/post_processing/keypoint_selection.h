// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "features/post_processing/candidate.h"

namespace dxslam {

/// Keeps at most `count` candidates, best first. The share `spread` of them is given out evenly:
/// each cell of a grid of `cell` pixels (doubled until there is a place for each cell) first takes
/// its best up to an equal quota, and the rest goes by score alone; cells with fewer candidates
/// leave their places to the others (paper III.B). spread 0 is the plain best N. The result does
/// not depend on the order of the input.
void select_keypoints(int width, int height, int count, double spread, int cell,
                      std::vector<Candidate>& candidates);

}  // namespace dxslam
