// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/recordings/rising_stamps.h"

#include <algorithm>
#include <cstddef>

namespace dxslam {

// The longest rising subsequence stays: the end of the best one of each length is kept, and what
// stands before each stamp in its own.
std::vector<bool> out_of_order(const std::vector<double>& stamps) {
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> ends;
  std::vector<std::size_t> before(stamps.size(), kNone);
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const auto place =
        std::lower_bound(ends.begin(), ends.end(), stamps[i],
                         [&](std::size_t end, double stamp) { return stamps[end] < stamp; });
    if (place != ends.begin()) before[i] = *(place - 1);
    if (place == ends.end()) {
      ends.push_back(i);
    } else if (stamps[i] < stamps[*place]) {  // of equal ones the first stays
      *place = i;
    }
  }
  std::vector<bool> left_out(stamps.size(), true);
  for (std::size_t i = ends.empty() ? kNone : ends.back(); i != kNone; i = before[i]) {
    left_out[i] = false;
  }
  return left_out;
}

}  // namespace dxslam
