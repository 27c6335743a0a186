// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace dxslam {

/// Median, 95th percentile and largest of the times of one stage.
struct StageSummary {
  std::size_t count = 0;
  double median_ms = 0.0;
  double p95_ms = 0.0;
  double max_ms = 0.0;
  double total_ms = 0.0;
};

/// How long each stage took, run by run. Thread-safe.
class StageTimes {
 public:
  void add(const std::string& stage, double ms);
  std::map<std::string, StageSummary> summaries() const;

 private:
  mutable std::mutex mutex_;
  std::map<std::string, std::vector<double>> times_;
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
