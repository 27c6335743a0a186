// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/se3.h"
#include "core/sim3.h"

namespace dxslam {

/// The motion (with scale if asked for) that takes `source` closest to `target` in the least
/// squares sense: target = result * source (Umeyama 1991; Horn 1987 without scale). Nothing if
/// there are fewer than three pairs, if a coordinate is not finite, or if all source or all target
/// points lie in one line within rounding. Throws ContractError if the two differ in size.
std::optional<Sim3> align_points(const std::vector<Eigen::Vector3d>& source,
                                 const std::vector<Eigen::Vector3d>& target, bool with_scale);

}  // namespace dxslam
