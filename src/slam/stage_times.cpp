// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/stage_times.h"

#include <algorithm>
#include <cmath>

namespace dxslam {
namespace {

constexpr double kShortest = 1e-4;   // milliseconds; the first bin holds all below
constexpr double kWidth = 1.01;      // of a bin: its upper by its lower end
constexpr std::size_t kBins = 2600;  // up to 5 hours; the last holds all above

std::size_t bin_of(double ms) {
  if (!(ms > kShortest)) return 0;
  const double bin = std::log(ms / kShortest) / std::log(kWidth);
  return static_cast<std::size_t>(std::min(bin, kBins - 1.0));
}

double middle_of(std::size_t bin) {
  return kShortest * std::pow(kWidth, static_cast<double>(bin) + 0.5);
}

}  // namespace

void StageTimes::add(const std::string& stage, double ms) {
  const std::lock_guard lock(mutex_);
  Histogram& h = times_[stage];
  if (h.count == 0) {
    h.counts.resize(kBins);
    h.min_ms = h.max_ms = ms;
  }
  ++h.counts[bin_of(ms)];
  ++h.count;
  h.min_ms = std::min(h.min_ms, ms);
  h.max_ms = std::max(h.max_ms, ms);
  h.total_ms += ms;
}

double StageTimes::Histogram::at_rank(std::size_t rank) const {
  std::size_t bin = 0;
  for (std::size_t before = counts[0]; before <= rank; before += counts[bin]) ++bin;
  return std::clamp(middle_of(bin), min_ms, max_ms);
}

std::map<std::string, StageSummary> StageTimes::summaries() const {
  const std::lock_guard lock(mutex_);
  std::map<std::string, StageSummary> summaries;
  for (const auto& [stage, h] : times_) {
    summaries[stage] = {h.count, h.at_rank(h.count / 2),
                        h.at_rank(std::min(h.count - 1, h.count * 95 / 100)), h.max_ms, h.total_ms};
  }
  return summaries;
}

}  // namespace dxslam
