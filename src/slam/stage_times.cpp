// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/stage_times.h"

#include <algorithm>
#include <numeric>

namespace dxslam {
namespace {

StageSummary summarise(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  const std::size_t n = times.size();
  return {n, times[n / 2], times[std::min(n - 1, n * 95 / 100)], times.back(),
          std::accumulate(times.begin(), times.end(), 0.0)};
}

}  // namespace

void StageTimes::add(const std::string& stage, double ms) {
  const std::lock_guard lock(mutex_);
  times_[stage].push_back(ms);
}

std::map<std::string, StageSummary> StageTimes::summaries() const {
  const std::lock_guard lock(mutex_);
  std::map<std::string, StageSummary> summaries;
  for (const auto& [stage, times] : times_) summaries[stage] = summarise(times);
  return summaries;
}

}  // namespace dxslam
