// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace dxslam {

/// Median, 95th percentile and largest of the times of one stage.
struct StageSummary {
  std::size_t count = 0;
  double median_ms = 0.0;  ///< right to 1 %, as p95_ms is
  double p95_ms = 0.0;
  double max_ms = 0.0;
  double total_ms = 0.0;
};

/// How long each stage took, counted in bins of 1 % width: its memory does not grow with the number
/// of times. Thread-safe.
class StageTimes {
 public:
  /// A time of 0 or more.
  void add(const std::string& stage, double ms);
  std::map<std::string, StageSummary> summaries() const;

 private:
  struct Histogram {
    std::vector<std::uint64_t> counts;
    std::size_t count = 0;
    double min_ms = 0.0;
    double max_ms = 0.0;
    double total_ms = 0.0;

    double at_rank(std::size_t rank) const;
  };

  mutable std::mutex mutex_;
  std::map<std::string, Histogram> times_;  // guarded by mutex_
};

/// Milliseconds since it was made.
class Stopwatch {
 public:
  double ms() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_)
        .count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace dxslam
