// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <vector>

namespace dxslam {

/// Summary of a list of errors, in their unit. `std` is that of the population (divided by count).
struct ErrorStatistics {
  double rmse = 0.0;
  double mean = 0.0;
  double median = 0.0;
  double std = 0.0;
  double min = 0.0;
  double max = 0.0;
  std::size_t count = 0;
};

/// All zero for an empty list.
ErrorStatistics summarise(std::vector<double> errors);

}  // namespace dxslam
