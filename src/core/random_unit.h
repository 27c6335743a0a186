// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

namespace dxslam {

/// A direction drawn evenly: the descriptors of made-up scenes in tests and benchmarks.
inline std::vector<float> random_unit(std::mt19937& random, std::size_t dimension) {
  std::normal_distribution<float> normal;
  std::vector<float> v(dimension);
  float square = 0.0F;
  for (float& x : v) {
    x = normal(random);
    square += x * x;
  }
  for (float& x : v) x /= std::sqrt(square);
  return v;
}

}  // namespace dxslam
