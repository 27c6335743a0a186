// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <algorithm>
#include <iterator>
#include <vector>

namespace dxslam {

/// The element whose `stamp` is nearest, the earlier of two; the end of an empty list. The list is
/// in time order.
template <class Stamped>
typename std::vector<Stamped>::const_iterator nearest_in_time(const std::vector<Stamped>& list,
                                                              double stamp) {
  const auto after =
      std::lower_bound(list.begin(), list.end(), stamp,
                       [](const Stamped& item, double value) { return item.stamp < value; });
  if (after == list.begin()) return after;
  const auto before = std::prev(after);
  const bool earlier = after == list.end() || stamp - before->stamp <= after->stamp - stamp;
  return earlier ? before : after;
}

}  // namespace dxslam
