// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

namespace dxslam {

/// For each of the stamps, which are numbers, whether it is to be left out so that the others rise,
/// each above the one before. As few as possible are left out: of a stamp that was put in the wrong
/// place, this one alone, wherever it stands.
std::vector<bool> out_of_order(const std::vector<double>& stamps);

}  // namespace dxslam
