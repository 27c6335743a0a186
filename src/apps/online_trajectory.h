// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <optional>
#include <string>

#include "core/trajectory.h"
#include "io/formats/trajectory_file.h"
#include "io/primitives/result_folder.h"

namespace dxslam::apps {

/// The poses as they are known while a command runs, in a file of its results, so that they survive
/// if it is killed. The first pose begins the results. A pose that cannot be written is no reason
/// to stop: that is said once, and the pose is written before the next one that can be. One thread
/// at a time.
class OnlineTrajectory {
 public:
  /// `folder` must outlive this; nothing is written without one.
  OnlineTrajectory(ResultFolder* folder, std::string name)
      : folder_(folder), name_(std::move(name)) {}

  /// Never throws InputError.
  void append(const StampedPose& pose);
  /// Writes what is still to be written, and closes the file. Throws InputError if that fails.
  void finish();

 private:
  void write_waiting();

  ResultFolder* folder_;
  std::string name_;
  std::optional<TrajectoryWriter> writer_;
  Trajectory waiting_;
  bool warned_ = false;
};

}  // namespace dxslam::apps
