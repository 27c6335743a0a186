// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>

#include "core/trajectory.h"
#include "io/formats/trajectory_file.h"
#include "io/primitives/result_folder.h"

namespace dxslam::apps {

/// The poses as they are known while a command runs, in a file of its results, so that they survive
/// if it is killed. The first pose begins the results. A pose that cannot be written is no reason
/// to stop: that is said once, and the pose is written before the next one that can be. Of those
/// that wait the newest kMostWaiting are kept. One thread at a time.
class OnlineTrajectory {
 public:
  static constexpr std::size_t kMostWaiting = 20'000;  // ten minutes, 2 MB

  /// `folder` must outlive this; nothing is written without one.
  OnlineTrajectory(ResultFolder* folder, std::string name)
      : folder_(folder), name_(std::move(name)) {}

  /// Never throws.
  void append(const StampedPose& pose);
  /// Writes what is still to be written, and closes the file. Throws InputError if that fails, and
  /// if poses are missing in it.
  void finish();

 private:
  void write_waiting();

  ResultFolder* folder_;
  std::string name_;
  std::optional<TrajectoryWriter> writer_;
  std::deque<StampedPose> waiting_;
  std::size_t forgotten_ = 0;
  bool warned_ = false;
};

}  // namespace dxslam::apps
