// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/formats/trajectory_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "io/formats/pose_matrix.h"
#include "io/formats/trajectory_file.h"
#include "io/primitives/limits.h"
#include "io/primitives/text_file.h"
#include "io/recordings/stamp_hint.h"

namespace dxslam {
namespace {

constexpr const char* kExpected = "a trajectory (TUM, KITTI or EuRoC)";
constexpr std::size_t kTumColumns = 8;
constexpr std::size_t kKittiColumns = 12;
constexpr std::size_t kEurocColumns = 17;      // of ground truth; 8 of poses alone
constexpr std::size_t kNanosecondDigits = 16;  // of a stamp, at least
constexpr double kQuaternionTolerance = 0.01;

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
  const Eigen::Quaterniond rotation(v[4], v[5], v[6], v[7]);
  if (!(std::abs(rotation.norm() - 1.0) <= kQuaternionTolerance)) {
    throw InputError(fmt::format("{}: quaternion of length {:.4g}, expected 1",
                                 at_line(path, row.line), rotation.norm()));
  }
  return {1e-9 * v[0], SE3(rotation, Eigen::Vector3d(v[1], v[2], v[3]))};
}

// The rows of a file, added one after the other.
class Collector {
 public:
  Collector(const std::string& path, std::optional<TrajectoryFormat> format)
      : path_(path), format_(format) {}

  void operator()(const TextRow& row) {
    if (!format_) format_ = format_of(path_, row);
    Trajectory& poses = file_.poses;
    if (poses.size() == limits::kPoses) {
      throw InputError(fmt::format("{}: more than {} poses, expected less",
                                   at_line(path_, row.line), limits::kPoses));
    }
    poses.push_back(pose_of(row));
    const std::size_t n = poses.size();
    if (n < 2 || poses[n - 1].stamp >= poses[n - 2].stamp) return;
    throw InputError(fmt::format("{}: stamp {:.6f} after {:.6f}, expected rising stamps",
                                 at_line(path_, row.line), poses[n - 1].stamp, poses[n - 2].stamp));
  }

  TrajectoryFile finish() {
    if (file_.poses.empty()) {
      throw InputError(fmt::format("{}: no pose in it, expected {}", path_, kExpected));
    }
    file_.format = *format_;
    if (!file_.has_stamps()) return std::move(file_);
    std::vector<double> stamps;
    for (const StampedPose& pose : file_.poses) stamps.push_back(pose.stamp);
    file_.hint = stamp_hint(stamps);
    return std::move(file_);
  }

 private:
  StampedPose pose_of(const TextRow& row) const {
    if (*format_ == TrajectoryFormat::kKitti) return kitti_pose(path_, row, file_.poses.size());
    if (*format_ == TrajectoryFormat::kEuroc) return euroc_pose(path_, row);
    return parse_tum_pose(path_, row);
  }

  const std::string& path_;
  std::optional<TrajectoryFormat> format_;
  TrajectoryFile file_;
};

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
  Collector collector(path, wanted);
  for_each_row(path, kExpected, [&](const TextRow& row) { collector(row); });
  return collector.finish();
}

}  // namespace dxslam
