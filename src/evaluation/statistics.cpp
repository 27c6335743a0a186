// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/statistics.h"

#include <algorithm>
#include <cmath>

namespace dxslam {

ErrorStatistics summarise(std::vector<double> errors) {
  ErrorStatistics result;
  result.count = errors.size();
  if (errors.empty()) return result;
  std::sort(errors.begin(), errors.end());
  const auto n = static_cast<double>(errors.size());
  double sum = 0.0;
  double squares = 0.0;
  for (const double error : errors) {
    sum += error;
    squares += error * error;
  }
  result.mean = sum / n;
  result.rmse = std::sqrt(squares / n);
  double variance = 0.0;
  for (const double error : errors) variance += (error - result.mean) * (error - result.mean);
  result.std = std::sqrt(variance / n);
  const std::size_t middle = errors.size() / 2;
  result.median =
      errors.size() % 2 == 1 ? errors[middle] : 0.5 * (errors[middle - 1] + errors[middle]);
  result.min = errors.front();
  result.max = errors.back();
  return result;
}

}  // namespace dxslam
