// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <chrono>
#include <vector>

#include "features/extractor.h"

namespace dxslam {

/// Splits the time since start() into named stages.
class StageTimer {
 public:
  void start() {
    stages_.clear();
    last_ = Clock::now();
  }
  /// Ends the stage that began at start() or at the last stop(). `name` is a string literal.
  void stop(const char* name) {
    const auto now = Clock::now();
    stages_.push_back({name, std::chrono::duration<double, std::milli>(now - last_).count()});
    last_ = now;
  }
  const std::vector<StageTime>& stages() const { return stages_; }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_;
  std::vector<StageTime> stages_;
};

}  // namespace dxslam
