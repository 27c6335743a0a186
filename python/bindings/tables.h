// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <vector>

#include "slam/observer.h"

namespace dxslam::python {

/// Keyframes and points as Python has them: columns of a table that somebody else may own.
struct KeyframeTable {
  std::shared_ptr<const std::vector<KeyframePose>> rows;
};
struct PointTable {
  std::shared_ptr<const std::vector<PointPosition>> rows;
};

}  // namespace dxslam::python
