// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include "core/trajectory.h"
#include "evaluation/association.h"
#include "evaluation/statistics.h"

namespace dxslam {

/// Which relative motions are compared.
struct RpeOptions {
  enum class Unit { kFrames, kSeconds };

  double delta = 1.0;         ///< distance of the two poses whose relative motion is compared
  Unit unit = Unit::kFrames;  ///< of delta; frames are matched poses, and must be whole
  /// Every pose starts a pair; else each pair starts where the one before ended.
  bool all_pairs = true;
  Alignment alignment = Alignment::kNone;  ///< matters only for the scale (kSim3)
  double max_difference = 0.01;            ///< as in AteOptions
};

/// What evaluate_rpe() finds.
struct RpeReport {
  ErrorStatistics translation;  ///< metres
  ErrorStatistics rotation;     ///< degrees
};

/// Relative pose error (Sturm et al. 2012): how far relative motions over a fixed distance differ,
/// E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j) with truth Q and estimate P. With seconds the second pose is
/// the one nearest to delta behind the first, if within half a median frame distance.
/// Throws InputError if no stamps match or no two poses are delta apart.
RpeReport evaluate_rpe(const Trajectory& truth, const Trajectory& estimate,
                       const RpeOptions& options = {});

}  // namespace dxslam
