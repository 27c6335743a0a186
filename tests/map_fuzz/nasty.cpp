// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "nasty.h"

#include <cmath>
#include <iterator>
#include <limits>

namespace dxslam::fuzz {

double Chance::number(double now) {
  static constexpr double kValues[] = {0.0,
                                       -0.0,
                                       5e-324,
                                       1e-300,
                                       1e-38,
                                       1e-12,
                                       1e-6,
                                       1e-4,
                                       1e-3,
                                       0.3,
                                       1.0,
                                       -1.0,
                                       2e4,
                                       1e5,
                                       999999.0,
                                       1e6,
                                       -1e6,
                                       1e7,
                                       1e9,
                                       1e20,
                                       1e38,
                                       1e39,
                                       1e300,
                                       -1e300,
                                       std::numeric_limits<double>::infinity(),
                                       -std::numeric_limits<double>::infinity(),
                                       std::numeric_limits<double>::quiet_NaN()};
  switch (below(6)) {
    case 0:
      return kValues[below(std::size(kValues))];
    case 1:
      return -now;
    case 2:
      return now * std::pow(10.0, 12.0 * uniform() - 6.0);
    case 3:
      return (uniform() - 0.5) * std::pow(10.0, 10.0 * uniform() - 3.0);
    default:
      return now + (uniform() - 0.5) * std::pow(10.0, 8.0 * uniform() - 4.0);
  }
}

std::uint32_t Chance::id(std::uint32_t now, std::size_t count) {
  const auto n = static_cast<std::uint32_t>(count);
  switch (below(8)) {
    case 0:
      return now + 1;
    case 1:
      return now - 1;
    case 2:
      return n;
    case 3:
      return n - 1;
    case 4:
      return 0xFFFFFFFFU;
    case 5:
      return static_cast<std::uint32_t>(bits() >> below(32));
    default:
      return static_cast<std::uint32_t>(below(count + 1));
  }
}

}  // namespace dxslam::fuzz
