// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include "map/map_types.h"

namespace dxslam {

/// Two keyframes that a closed loop has tied together. Kept by id for good: where one of them was
/// culled later, its living anchor takes its place (Map::anchor_of).
struct LoopEdge {
  KeyframeId a = kNoId;
  KeyframeId b = kNoId;
};

}  // namespace dxslam
