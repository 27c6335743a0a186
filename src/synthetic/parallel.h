// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <algorithm>
#include <thread>
#include <vector>

namespace dxslam {

/// Calls work(begin, end) on `threads` contiguous parts of [0, count) at once and waits for all.
/// `work` must not throw. The result may not depend on how the range is cut.
template <class Work>
void parallel_ranges(int count, int threads, const Work& work) {
  const int parts = std::clamp(threads, 1, std::max(count, 1));
  std::vector<std::thread> helpers;
  for (int part = 1; part < parts; ++part) {
    helpers.emplace_back(
        [&work, part, parts, count] { work(count * part / parts, count * (part + 1) / parts); });
  }
  work(0, count / parts);
  for (std::thread& helper : helpers) helper.join();
}

}  // namespace dxslam
