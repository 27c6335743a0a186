// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/trajectory.h"
#include "io/primitives/text_file.h"

namespace dxslam {

/// Reads "stamp tx ty tz qx qy qz qw" rows (TUM format: seconds, metres, unit quaternion of
/// world_from_camera). Comments, blank lines and commas for blanks are accepted. Throws InputError
/// naming file and line for anything else: other column counts, NaN, stamps going backwards, a
/// quaternion whose length is off by more than 1 %, no pose at all.
Trajectory read_trajectory(const std::string& path);

/// One such row. Throws InputError as read_trajectory does.
StampedPose parse_tum_pose(const std::string& path, const TextRow& row);

/// One row without line end, as read_trajectory reads it: microseconds, 1e-9 m.
std::string format_pose(const StampedPose& pose);

/// The whole file, replaced atomically.
void write_trajectory(const std::string& path, const Trajectory& trajectory);

/// Writes a trajectory while it grows. Each pose is handed to the system at once, so all appended
/// poses survive a crash of the program. One thread at a time.
class TrajectoryWriter {
 public:
  /// Creates or empties the file; throws InputError if that fails.
  explicit TrajectoryWriter(const std::string& path);
  ~TrajectoryWriter();
  TrajectoryWriter(const TrajectoryWriter&) = delete;
  TrajectoryWriter& operator=(const TrajectoryWriter&) = delete;

  /// Throws InputError if the row could not be written in full (full disk); the file then ends
  /// with the row before.
  void append(const StampedPose& pose);

 private:
  void write(std::string_view text);

  std::string path_;
  int file_ = -1;
  std::int64_t size_ = 0;  // bytes of whole rows
};

}  // namespace dxslam
