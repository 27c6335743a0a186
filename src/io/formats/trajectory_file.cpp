// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/formats/trajectory_file.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "core/error.h"
#include "io/formats/pose_matrix.h"
#include "io/primitives/atomic_file.h"
#include "io/primitives/text_file.h"

namespace dxslam {
namespace {

constexpr std::string_view kHeader = "# timestamp tx ty tz qx qy qz qw\n";
constexpr const char* kExpected = "a trajectory in TUM format (stamp tx ty tz qx qy qz qw)";
constexpr double kQuaternionTolerance = 0.01;

// One line, and no pose: nothing is lost with it.
bool is_comment(std::string_view head) {
  return head.starts_with('#') && head.find('\n') >= head.size() - 1;
}

}  // namespace

FileKind trajectory_kind() {
  return {"a trajectory of dxslam", [](std::string_view head) {
            // A full disk or a kill may have cut the file that grows.
            return head.starts_with(kHeader) || kHeader.starts_with(head) || is_comment(head);
          }};
}

StampedPose parse_tum_pose(const std::string& path, const TextRow& row) {
  static constexpr const char* kColumns[] = {"stamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"};
  if (row.fields.size() != std::size(kColumns)) {
    refuse_columns(path, row, "8 (stamp tx ty tz qx qy qz qw)");
  }
  double v[8];
  for (std::size_t i = 0; i < std::size(kColumns); ++i) {
    v[i] = finite_field(path, row, i, kColumns[i]);
  }
  return {v[0], pose_of_row(path, row, {v[1], v[2], v[3]}, {v[7], v[4], v[5], v[6]})};
}

SE3 pose_of_row(const std::string& path, const TextRow& row, const Eigen::Vector3d& translation,
                const Eigen::Quaterniond& rotation) {
  const double length = rotation.norm();
  if (!(std::abs(length - 1.0) <= kQuaternionTolerance)) {
    throw InputError(fmt::format("{}: quaternion of length {:.4g}, expected 1",
                                 at_line(path, row.line), length));
  }
  require_near(translation, at_line(path, row.line));
  return {rotation, translation};
}

TrajectoryCollector::TrajectoryCollector(std::string path, std::string expected)
    : path_(std::move(path)), expected_(std::move(expected)) {}

void TrajectoryCollector::add(const TextRow& row, const StampedPose& pose) {
  if (poses_.size() == limits::kPoses) {
    throw InputError(fmt::format("{}: more than {} poses, expected less", at_line(path_, row.line),
                                 limits::kPoses));
  }
  if (!poses_.empty() && pose.stamp < poses_.back().stamp) {
    throw InputError(fmt::format("{}: stamp {:.16g} after {:.16g}, expected rising stamps",
                                 at_line(path_, row.line), pose.stamp, poses_.back().stamp));
  }
  if (!poses_.empty() && pose.stamp == poses_.back().stamp) {
    ++repeated_;
  } else {
    poses_.push_back(pose);
  }
}

Trajectory TrajectoryCollector::finish() {
  if (poses_.empty()) {
    throw InputError(fmt::format("{}: no pose in it, expected {}", path_, expected_));
  }
  return std::move(poses_);
}

Trajectory read_trajectory(const std::string& path) {
  TrajectoryCollector poses(path, kExpected);
  for_each_row(path, kExpected,
               [&](const TextRow& row) { poses.add(row, parse_tum_pose(path, row)); });
  return poses.finish();
}

std::string format_pose(const StampedPose& pose) {
  const Eigen::Vector3d& t = pose.world_from_camera.translation();
  const Eigen::Quaterniond& q = pose.world_from_camera.rotation();
  return fmt::format("{:.6f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}", pose.stamp, t.x(),
                     t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
}

void write_trajectory(const std::string& path, const Trajectory& trajectory) {
  std::string text(kHeader);
  for (const StampedPose& pose : trajectory) text += format_pose(pose) + "\n";
  write_file_atomically(path, text);
}

TrajectoryWriter::TrajectoryWriter(const std::string& path) : file_(path) { file_.append(kHeader); }

void TrajectoryWriter::append(const StampedPose& pose) { file_.append(format_pose(pose) + "\n"); }

}  // namespace dxslam
