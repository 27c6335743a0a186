// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <optional>

#include "relocalization/relocalizer.h"

namespace dxslam {

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
