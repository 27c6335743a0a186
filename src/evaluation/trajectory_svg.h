// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>

#include "core/trajectory.h"

namespace dxslam {

/// A self-contained SVG picture of one or two trajectories in plan: the two world axes along which
/// they extend farthest, at equal scale, with grid, scale bar, start and end marks and a legend.
/// `truth` may be empty; where given, the estimate has to be aligned to it. A line is interrupted
/// where its stamps leave out more than ten median steps and half a second (tracking lost).
/// An empty estimate gives a picture that says so. Throws ContractError for poses that are not
/// finite.
std::string draw_trajectory_svg(const Trajectory& estimate, const Trajectory& truth,
                                const std::string& title, const std::string& subtitle = "");

}  // namespace dxslam
