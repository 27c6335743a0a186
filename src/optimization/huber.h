// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cmath>

namespace dxslam {

/// The Huber kernel on a squared error: returns the cost (twice over, as all squared errors are)
/// and sets the weight that a quadratic cost of the same slope has. Internal to this layer.
inline double huber(double error2, double width2, double& weight) {
  weight = 1.0;
  if (error2 <= width2) return error2;
  weight = std::sqrt(width2 / error2);
  return 2.0 * weight * error2 - width2;
}

}  // namespace dxslam
