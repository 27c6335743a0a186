// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "core/error.h"
#include "io/formats/pose_matrix.h"
#include "io/primitives/text_file.h"
#include "io/recordings/sequence_formats.h"

namespace dxslam {
namespace {

namespace fs = std::filesystem;

using Projection = std::array<double, 12>;  // 3x4, row by row

Projection projection_of(const std::string& path, int camera) {
  const std::string label = fmt::format("P{}:", camera);
  for (const TextRow& row : read_table(path, "a calibration of KITTI odometry")) {
    if (row.fields.front() != label) continue;
    if (row.fields.size() != 13) {
      throw InputError(fmt::format("{}: {} numbers of {}, expected 12 (3x4)",
                                   at_line(path, row.line), row.fields.size() - 1, label));
    }
    Projection p{};
    for (std::size_t i = 0; i < p.size(); ++i) {
      p[i] = finite_field(path, row, i + 1, "element of the projection matrix");
    }
    if (!(p[0] > 0.0 && p[5] > 0.0) || p[1] != 0.0 || p[10] != 1.0) {
      throw InputError(fmt::format("{}: {} is no projection of a rectified camera",
                                   at_line(path, row.line), label));
    }
    return p;
  }
  throw InputError(
      fmt::format("{}: no line {}, expected the projection of each camera", path, label));
}

std::vector<double> read_times(const std::string& path) {
  std::vector<double> times;
  for_each_row(path, "one time per line", [&](const TextRow& row) {
    if (row.fields.size() != 1) refuse_columns(path, row, "1 (time)");
    const double time = finite_field(path, row, 0, "time");
    if (!times.empty() && time < times.back()) {
      throw InputError(fmt::format("{}: time {:.16g} after {:.16g}, expected rising times",
                                   at_line(path, row.line), time, times.back()));
    }
    if (times.size() == limits::kFrames) {
      throw InputError(fmt::format("{}: more than {} times, expected less", at_line(path, row.line),
                                   limits::kFrames));
    }
    times.push_back(time);
  });
  return times;
}

std::vector<SE3> read_kitti_poses(const std::string& path) {
  std::vector<SE3> poses;
  for_each_row(path, "one 3x4 pose per line", [&](const TextRow& row) {
    if (row.fields.size() != 12) refuse_columns(path, row, "12 (a 3x4 pose row by row)");
    double values[16] = {};
    values[15] = 1.0;
    for (std::size_t i = 0; i < 12; ++i) values[i] = finite_field(path, row, i, "pose element");
    poses.push_back(pose_from_row_major(values, at_line(path, row.line)));
  });
  return poses;
}

// The file of poses, empty where there is none.
std::string find_poses(const std::string& folder) {
  const fs::path own = fs::path(folder) / "poses.txt";
  const fs::path common = fs::absolute(folder).lexically_normal() / ".." / ".." / "poses" /
                          (folder_name(folder) + ".txt");
  for (const fs::path& path : {own, common}) {
    if (fs::exists(path)) return path.lexically_normal().string();
  }
  return {};
}

/// Camera 0 and 1 are the grey pair, 2 and 3 the colour pair.
int choose_camera(const std::string& folder, const std::string& eye) {
  const int right = eye == "right" ? 1 : 0;
  for (const int camera : {right, 2 + right}) {
    if (fs::is_directory(in_folder(folder, fmt::format("image_{}", camera)))) return camera;
  }
  throw InputError(
      fmt::format("{}: neither image_{} nor image_{}, expected the images of KITTI "
                  "odometry",
                  folder, right, 2 + right));
}

void set_camera(const std::string& folder, const Projection& p, cv::Size size,
                SequenceListing& listing) {
  listing.calibration_source = in_folder(folder, "calib.txt");
  Camera& camera = listing.camera;
  camera.width = size.width;
  camera.height = size.height;
  camera.fx = p[0];
  camera.fy = p[5];
  camera.cx = p[2];
  camera.cy = p[6];
  camera.fps = 10.0;
}

Trajectory true_trajectory(const std::string& file, const std::vector<double>& times,
                           const Projection& p) {
  const std::vector<SE3> poses = read_kitti_poses(file);
  if (poses.size() != times.size()) {
    throw InputError(fmt::format("{}: {} poses, expected one for each of the {} images", file,
                                 poses.size(), times.size()));
  }
  // The fourth column is the camera's matrix times the offset of camera 0 in its frame.
  const SE3 camera_from_zero(
      Eigen::Quaterniond::Identity(),
      Eigen::Vector3d((p[3] - p[2] * p[11]) / p[0], (p[7] - p[6] * p[11]) / p[5], p[11]));
  Trajectory truth;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i > 0 && times[i] == times[i - 1]) continue;
    truth.push_back({times[i], poses[i] * camera_from_zero.inverse()});
  }
  return truth;
}

}  // namespace

SequenceListing list_kitti(const std::string& folder, const SequenceOptions& options) {
  SequenceListing listing;
  listing.name = folder_name(folder);
  const int camera = choose_camera(folder, options.eye);
  if (camera < 2 && fs::is_directory(in_folder(folder, fmt::format("image_{}", camera + 2)))) {
    listing.notes.push_back(
        fmt::format("of the grey and the colour images the grey ones, image_{}, are used", camera));
  }
  const auto images = list_images(in_folder(folder, fmt::format("image_{}", camera)), listing);
  const Projection p = projection_of(in_folder(folder, "calib.txt"), camera);
  if (!use_explicit_calibration(folder, options, listing)) {
    set_camera(folder, p, image_size(images), listing);
  }
  const std::vector<double> times = read_times(in_folder(folder, "times.txt"));
  if (times.size() != images.size()) {
    throw InputError(fmt::format("{}: {} times, expected one for each of the {} images",
                                 in_folder(folder, "times.txt"), times.size(), images.size()));
  }
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (i > 0 && times[i] == times[i - 1]) {
      listing.skipped.push_back(
          {listing.frames.size(), fmt::format("{}: has the time of the image before, {:.16g} s",
                                              images[i].string(), times[i])});
    } else {
      listing.frames.push_back({times[i], images[i].string(), {}});
    }
  }
  const std::string pose_file = find_poses(folder);
  if (!pose_file.empty()) {
    take_truth(listing, [&] { return true_trajectory(pose_file, times, p); });
  }
  return listing;
}

}  // namespace dxslam
