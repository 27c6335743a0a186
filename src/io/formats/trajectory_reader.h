// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <vector>

#include "core/trajectory.h"

namespace dxslam {

/// How files of others hold a trajectory:
/// - kTum: "stamp tx ty tz qx qy qz qw", seconds;
/// - kKitti: twelve numbers, the upper three rows of a 4x4 pose row by row; no stamps;
/// - kEuroc: CSV, "stamp x y z qw qx qy qz" and what may follow, nanoseconds (the data.csv of
///   EuRoC's state_groundtruth_estimate0, poses of the body).
enum class TrajectoryFormat { kTum, kKitti, kEuroc };

/// A trajectory and what its file says about it.
struct TrajectoryFile {
  Trajectory poses;  ///< where the file has no stamps, these are 0, 1, 2, ...
  TrajectoryFormat format = TrajectoryFormat::kTum;
  std::vector<std::string> hints;  ///< sentences: stamps that come again or look like no seconds

  bool has_stamps() const { return format != TrajectoryFormat::kKitti; }
};

/// "auto", "tum", "kitti" and "euroc".
const std::vector<std::string>& trajectory_format_names();

/// Reads a file in the format of that name; `auto` goes by the columns of the first row. Throws
/// InputError naming file and line for anything else, as read_trajectory does.
TrajectoryFile read_trajectory_file(const std::string& path, const std::string& format = "auto");

}  // namespace dxslam
