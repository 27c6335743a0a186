// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "map/map_types.h"

namespace dxslam {

/// One candidate of one keyframe, and what became of it.
struct LoopRecord {
  std::int64_t frame = 0;  ///< of the query
  KeyframeId query = kNoId;
  KeyframeId candidate = kNoId;
  double bow_score = 0.0;
  double global_distance = 0.0;  ///< NaN where there is none
  bool accepted = false;
  std::string verdict;  ///< "accepted", or why not
  std::string effect;   ///< on the map: none, weld, bend or join
  int inliers = 0;
  double found_share = 0.0;    ///< of the points that should be in view
  double covered_share = 0.0;  ///< of the image's parts where points are due
  int confirmations = 0;       ///< neighbours of the query that see the place
  double contradiction = 0.0;  ///< metres between the loop and the map before
  double largest_move = 0.0;   ///< metres, of a keyframe
  struct Joined {
    std::uint32_t kept = 0, gone = 0;
  };
  std::optional<Joined> joined;  ///< components that became one
};

/// What became of the candidates for loops: counts of all, and the records of the last ones. Where
/// there are too many, rejected ones are forgotten before accepted ones.
class LoopLog {
 public:
  explicit LoopLog(std::size_t most = 2000) : most_(most) {}

  void add(LoopRecord record);
  /// In order.
  const std::deque<LoopRecord>& records() const { return records_; }
  std::size_t accepted() const { return accepted_; }        ///< of all
  std::size_t corrections() const { return corrections_; }  ///< of these, that moved keyframes
  std::size_t forgotten() const { return forgotten_; }      ///< without a record

 private:
  std::size_t most_;
  std::deque<LoopRecord> records_;
  std::size_t accepted_ = 0;
  std::size_t corrections_ = 0;
  std::size_t forgotten_ = 0;
};

}  // namespace dxslam
