// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/formats/trajectory_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/error.h"
#include "io/formats/pose_matrix.h"
#include "io/formats/trajectory_file.h"
#include "io/primitives/text_file.h"
#include "io/recordings/stamp_hint.h"

namespace dxslam {
namespace {

constexpr const char* kExpected = "a trajectory (TUM, KITTI or EuRoC)";
constexpr std::size_t kTumColumns = 8;
constexpr std::size_t kKittiColumns = 12;
constexpr std::size_t kEurocColumns = 17;      // of ground truth; 8 of poses alone
constexpr std::size_t kNanosecondDigits = 16;  // of a stamp, at least

bool is_nanoseconds(const std::string& stamp) {
  return stamp.size() >= kNanosecondDigits &&
         stamp.find_first_not_of("0123456789") == std::string::npos;
}

TrajectoryFormat format_of(const std::string& path, const TextRow& row) {
  const std::size_t columns = row.fields.size();
  if (columns == kKittiColumns) return TrajectoryFormat::kKitti;
  if (columns == kEurocColumns) return TrajectoryFormat::kEuroc;
  if (columns != kTumColumns) {
    refuse_columns(path, row,
                   "8 (TUM: stamp tx ty tz qx qy qz qw), 12 (KITTI: a 3x4 pose row by row) or 17 "
                   "(EuRoC: stamp, x, y, z, qw, qx, qy, qz, ...)");
  }
  const bool euroc = row.text.find(',') != std::string::npos && is_nanoseconds(row.fields.front());
  return euroc ? TrajectoryFormat::kEuroc : TrajectoryFormat::kTum;
}

StampedPose kitti_pose(const std::string& path, const TextRow& row, std::size_t index) {
  if (row.fields.size() != kKittiColumns) {
    refuse_columns(path, row, "12 (KITTI: a 3x4 pose row by row)");
  }
  double values[16] = {};
  values[15] = 1.0;
  for (std::size_t i = 0; i < kKittiColumns; ++i) {
    values[i] = finite_field(path, row, i, "pose element");
  }
  return {static_cast<double>(index), pose_from_row_major(values, at_line(path, row.line))};
}

StampedPose euroc_pose(const std::string& path, const TextRow& row) {
  static constexpr const char* kColumns[] = {"stamp", "x", "y", "z", "qw", "qx", "qy", "qz"};
  if (row.fields.size() < std::size(kColumns)) {
    refuse_columns(path, row, "8 or more (EuRoC: stamp, x, y, z, qw, qx, qy, qz, ...)");
  }
  double v[8];
  for (std::size_t i = 0; i < std::size(kColumns); ++i) {
    v[i] = finite_field(path, row, i, kColumns[i]);
  }
  return {1e-9 * v[0], pose_of_row(path, row, {v[1], v[2], v[3]}, {v[4], v[5], v[6], v[7]})};
}

StampedPose pose_of(TrajectoryFormat format, const std::string& path, const TextRow& row,
                    std::size_t index) {
  if (format == TrajectoryFormat::kKitti) return kitti_pose(path, row, index);
  if (format == TrajectoryFormat::kEuroc) return euroc_pose(path, row);
  return parse_tum_pose(path, row);
}

// What is odd about the stamps.
std::vector<std::string> hints_of(const Trajectory& poses, std::size_t repeated) {
  std::vector<std::string> hints;
  if (repeated > 0) {
    hints.push_back(fmt::format("{} of {} poses have the stamp of the one before and are left out",
                                repeated, poses.size() + repeated));
  }
  std::vector<double> stamps;
  for (const StampedPose& pose : poses) stamps.push_back(pose.stamp);
  if (std::string hint = stamp_hint(stamps); !hint.empty()) hints.push_back(std::move(hint));
  return hints;
}

}  // namespace

const std::vector<std::string>& trajectory_format_names() {
  static const std::vector<std::string> names = {"auto", "tum", "kitti", "euroc"};
  return names;
}

TrajectoryFile read_trajectory_file(const std::string& path, const std::string& format) {
  const std::vector<std::string>& names = trajectory_format_names();
  const auto found = std::find(names.begin(), names.end(), format);
  if (found == names.end()) {
    throw InputError(fmt::format("no trajectory format {}, expected {}", in_quotes(format),
                                 fmt::join(names, ", ")));
  }
  std::optional<TrajectoryFormat> wanted;
  if (found != names.begin()) {
    wanted = static_cast<TrajectoryFormat>(found - names.begin() - 1);
  }
  TrajectoryCollector poses(path, kExpected);
  for_each_row(path, kExpected, [&](const TextRow& row) {
    if (!wanted) wanted = format_of(path, row);
    poses.add(row, pose_of(*wanted, path, row, poses.size()));
  });
  TrajectoryFile file;
  file.poses = poses.finish();
  file.format = *wanted;
  if (file.has_stamps()) file.hints = hints_of(file.poses, poses.repeated());
  return file;
}

}  // namespace dxslam
