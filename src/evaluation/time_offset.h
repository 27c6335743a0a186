// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <optional>

#include "core/trajectory.h"
#include "evaluation/association.h"

namespace dxslam {

struct TimeOffsetOptions {
  double range = 1.0;          ///< offsets from -range to range are tried, seconds
  double max_truth_gap = 0.5;  ///< seconds; no truth is interpolated in longer gaps
  Alignment alignment = Alignment::kSe3;
};

struct TimeOffset {
  double offset = 0.0;   ///< seconds, to be added to the stamps of the estimate
  double rmse = 0.0;     ///< metres, of positions against the interpolated truth, with the offset
  bool at_edge = false;  ///< at the end of the range: beyond it may be a better one
};

/// The offset of clocks with which the estimate fits the truth best, to a tenth of a millisecond:
/// by the position error after alignment at 500 poses at most, over offsets with which half as many
/// of these have truth as with the best offset. Throws InputError if no offset leaves three poses
/// that can be aligned, ContractError unless both are by rising stamp and not empty.
TimeOffset search_time_offset(const Trajectory& truth, const Trajectory& estimate,
                              const TimeOffsetOptions& options = {});

/// An offset of up to a second with which the error, `rmse` without it (metres), is less than half
/// as large: the clocks are likely to differ. None where it cannot be told.
std::optional<TimeOffset> likely_offset(const Trajectory& truth, const Trajectory& estimate,
                                        double rmse, Alignment alignment = Alignment::kSe3);

/// Each pose `seconds` later.
Trajectory shifted(const Trajectory& trajectory, double seconds);

}  // namespace dxslam
