// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <vector>

#include "core/trajectory.h"

namespace dxslam::apps {

/// The files to compare, and their formats as in read_trajectory_file.
struct TrajectoryFiles {
  std::string truth;
  std::string truth_format = "auto";
  std::string estimate;
  std::string format = "auto";  ///< of the estimate
};

/// Truth and estimate, ready to be compared.
struct TrajectoryPair {
  Trajectory truth;
  Trajectory estimate;
  bool has_stamps = true;  ///< false: neither has, stamps are the numbers of the poses
  bool by_index = false;   ///< at least one has none, so that poses belong together by number
  std::vector<std::string> notes;  ///< stamps that do not look like seconds, one sentence each
};

/// Reads both. Where one has no stamps (KITTI) it gets those of the other, which must have as many
/// poses. Throws InputError.
TrajectoryPair load_trajectory_pair(const TrajectoryFiles& files);

}  // namespace dxslam::apps
