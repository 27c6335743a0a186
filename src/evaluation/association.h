// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <vector>

#include "core/sim3.h"
#include "core/trajectory.h"

namespace dxslam {

/// Two poses of the same moment.
struct PosePair {
  StampedPose truth;
  StampedPose estimate;
};

/// For each pose of the shorter trajectory the pose of the longer one nearest in time, if not more
/// than `max_difference` seconds away (as evo does; the earlier of two equally near). By rising
/// stamp; empty if none match. Throws ContractError unless both are by rising stamp.
std::vector<PosePair> associate(const Trajectory& truth, const Trajectory& estimate,
                                double max_difference);

/// The same, but throws InputError, with the two time spans, if none match or one holds no pose.
std::vector<PosePair> associate_or_throw(const Trajectory& truth, const Trajectory& estimate,
                                         double max_difference);

/// What may be fitted to bring the estimate into the frame of the truth.
enum class Alignment { kNone, kSe3, kSim3 };

/// truth_from_estimate that fits the positions of the pairs best. Throws InputError if there are
/// too few pairs or they lie on one line.
Sim3 align(const std::vector<PosePair>& pairs, Alignment alignment);

/// Each pose moved by truth_from_estimate: positions scaled, rotated and shifted.
Trajectory transformed(const Trajectory& estimate, const Sim3& truth_from_estimate);

}  // namespace dxslam
