// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/trajectory.h"
#include "io/primitives/growing_file.h"
#include "io/primitives/output_file.h"
#include "io/primitives/text_file.h"

namespace dxslam {

/// Reads "stamp tx ty tz qx qy qz qw" rows (TUM format: seconds, metres, unit quaternion of
/// world_from_camera). Comments, blank lines and commas for blanks are accepted. Throws InputError
/// naming file and line for anything else: other column counts, NaN, stamps going backwards, a
/// quaternion whose length is off by more than 1 %, no pose at all.
/// A pose with the stamp of the one before it is left out.
Trajectory read_trajectory(const std::string& path);

/// One such row. Throws InputError as read_trajectory does.
StampedPose parse_tum_pose(const std::string& path, const TextRow& row);

/// Makes a trajectory of the rows of a file, whatever their format.
class TrajectoryCollector {
 public:
  /// `expected` says in messages what should be in the file.
  TrajectoryCollector(std::string path, std::string expected);

  /// The pose of the next row. Throws InputError for stamps going backwards, and beyond
  /// limits::kPoses. A second pose of one stamp is left out: the stamp cannot stand for both.
  void add(const TextRow& row, const StampedPose& pose);
  std::size_t size() const { return poses_.size(); }
  /// How many poses were left out.
  std::size_t repeated() const { return repeated_; }
  /// Throws InputError if there is none.
  Trajectory finish();

 private:
  std::string path_;
  std::string expected_;
  Trajectory poses_;
  std::size_t repeated_ = 0;
};

/// A pose of a row's numbers. Throws InputError, naming the row, for a quaternion whose length is
/// off by more than 1 %.
SE3 pose_of_row(const std::string& path, const TextRow& row, const Eigen::Vector3d& translation,
                const Eigen::Quaterniond& rotation);

/// One row without line end, as read_trajectory reads it: microseconds, 1e-9 m.
std::string format_pose(const StampedPose& pose);

/// The whole file, replaced atomically.
void write_trajectory(const std::string& path, const Trajectory& trajectory);

/// What write_trajectory() and TrajectoryWriter write, and a single line of comment; not other
/// files in TUM format.
FileKind trajectory_kind();

/// Writes a trajectory while it grows. Each pose is handed to the system at once, so all appended
/// poses survive a crash of the program. One thread at a time.
class TrajectoryWriter {
 public:
  /// Creates or empties the file; throws InputError if that fails.
  explicit TrajectoryWriter(const std::string& path);

  /// Throws InputError if the row could not be written in full (full disk); the file then ends
  /// with the row before.
  void append(const StampedPose& pose);

 private:
  GrowingFile file_;
};

}  // namespace dxslam
