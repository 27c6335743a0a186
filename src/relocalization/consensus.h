// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <optional>

#include "relocalization/relocalizer.h"

namespace dxslam {

struct ConsensusOptions {
  int frames = 3;
  int min_matched = 10;
  int min_inliers = 15;
  double max_gap = 1.0;
  double max_speed = 1.5;
  double max_turn = 120.0;
  double distance_slack = 0.1;
  double angle_slack = 5.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("frames", self.frames, {2, 100}, "frames", "weak poses in a row that have to agree");
    visit("min_matched", self.min_matched, {4, 100000}, "points",
          "of a weak pose: matches by descriptor alone that agree with it");
    visit("min_inliers", self.min_inliers, {6, 100000}, "points",
          "of a weak pose: map points that agree with it");
    visit("max_gap", self.max_gap, {0.001, 60}, "s", "longest time between two of them");
    visit("max_speed", self.max_speed, {0, 100}, "m/s", "how fast the camera may move");
    visit("max_turn", self.max_turn, {0, 3600}, "degrees/s", "how fast it may turn");
    visit("distance_slack", self.distance_slack, {0, 10}, "m", "error of a weak pose");
    visit("angle_slack", self.angle_slack, {0, 180}, "degrees", "the same of its direction");
  }
};

/// Relocalization over consecutive frames: where no single frame carries a pose that can be relied
/// on, several weak ones in a row that fit the motion of one camera do. Belongs to one thread.
class RelocalizationConsensus {
 public:
  /// Throws InputError for options out of range.
  explicit RelocalizationConsensus(const ConsensusOptions& options = {});

  /// Takes the report of the next frame, stamps rising. Returns the report to act on: this one,
  /// marked as accepted, if it was accepted already or makes the row of weak poses long enough.
  std::optional<RelocalizationReport> add(double stamp, const RelocalizationReport& report);
  /// Forgets all frames, e.g. where a new sequence starts.
  void reset();

 private:
  bool agrees(double stamp, const RelocalizationReport& report) const;

  ConsensusOptions options_;
  RelocalizationReport last_;
  double last_stamp_ = 0.0;
  int agreeing_ = 0;  // weak poses in a row, the last one included
};

}  // namespace dxslam
