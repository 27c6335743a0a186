// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace dxslam::apps {

/// Progress on stderr: on a terminal one line that is redrawn, with bar, rate and time left, else a
/// plain line now and then. One thread at a time.
class Progress {
 public:
  enum class Unit { kItems, kShare };  ///< kShare: what is done is told in per cent
  /// `total` 0: nobody knows how many there will be.
  Progress(std::string title, std::size_t total, Unit unit = Unit::kItems);
  /// `state` is a word or two, e.g. "tracking" or "lost".
  void update(std::size_t done, const std::string& state);
  /// Ends the line.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  void draw(std::size_t done, const std::string& state, double elapsed) const;

  std::string title_;
  std::size_t total_;
  Unit unit_;
  bool terminal_;
  bool drawn_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
};

}  // namespace dxslam::apps
