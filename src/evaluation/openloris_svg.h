// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <vector>

#include "evaluation/openloris.h"

namespace dxslam {

/// What one system did in some scenes.
struct OpenlorisSystem {
  std::string name;
  std::vector<OpenlorisReport> scenes;  ///< each scene at most once
};

/// A self-contained SVG picture of when each system knew where it was, like Fig. 4 of the DXSLAM
/// paper: time to the right, all scenes side by side, one row a system. Blue where the pose is
/// correct, red where it is wrong, grey where there is none; the first pose of a sequence is a blue
/// dot or a red cross. Dots on the top line are starts of sequences. Each scene carries its correct
/// rate (top left) and C-ATE (bottom right).
/// Throws ContractError if there is nothing to draw or reports of one scene have different truths.
std::string draw_openloris_svg(const std::vector<OpenlorisSystem>& systems,
                               const std::string& title, const std::string& subtitle = "");

}  // namespace dxslam
