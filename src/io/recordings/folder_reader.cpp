// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/error.h"
#include "io/formats/pose_matrix.h"
#include "io/primitives/image_file.h"
#include "io/primitives/text_file.h"
#include "io/recordings/sequence_formats.h"

namespace dxslam {
namespace {

Camera read_intrinsics(const std::string& path, cv::Size size) {
  const std::vector<TextRow> rows = read_table(path, "a 3x3 camera matrix");
  Eigen::Matrix3d k;
  if (rows.size() != 3) {
    throw InputError(fmt::format("{}: {} rows, expected a 3x3 camera matrix", path, rows.size()));
  }
  for (int i = 0; i < 3; ++i) {
    const TextRow& row = rows[static_cast<std::size_t>(i)];
    if (row.fields.size() != 3) refuse_columns(path, row, "a 3x3 camera matrix");
    for (int j = 0; j < 3; ++j) {
      k(i, j) = finite_field(path, row, static_cast<std::size_t>(j), "camera matrix element");
    }
  }
  if (k(0, 1) != 0 || k(1, 0) != 0 || k(2, 0) != 0 || k(2, 1) != 0 || k(2, 2) != 1) {
    throw InputError(
        fmt::format("{}: expected a camera matrix 'fx 0 cx, 0 fy cy, 0 0 1' without skew", path));
  }
  Camera camera;
  camera.width = size.width;
  camera.height = size.height;
  camera.fx = k(0, 0);
  camera.fy = k(1, 1);
  camera.cx = k(0, 2);
  camera.cy = k(1, 2);
  camera.fps = kDefaultFps;
  camera.prepare(path);
  return camera;
}

std::vector<SE3> read_poses(const std::string& path, std::size_t images) {
  std::vector<SE3> poses;
  for_each_row(path, "one 4x4 pose per line", [&](const TextRow& row) {
    if (row.fields.size() != 16) refuse_columns(path, row, "16 (a 4x4 pose row by row)");
    double values[16];
    for (std::size_t i = 0; i < 16; ++i) values[i] = finite_field(path, row, i, "pose element");
    poses.push_back(pose_from_row_major(values, at_line(path, row.line)));
  });
  if (poses.size() != images) {
    throw InputError(fmt::format("{}: {} poses, expected one for each of the {} images", path,
                                 poses.size(), images));
  }
  return poses;
}

/// Of the kinds that can hold depth, the one there is; PNG if there is none.
std::string depth_file(const std::string& folder, const std::string& stem) {
  const std::string path = in_folder(folder, "depth/" + stem);
  for (const char* ending : {".png", ".tiff", ".tif", ".exr", ".pgm"}) {
    if (std::filesystem::exists(path + ending)) return path + ending;
  }
  return path + ".png";
}

}  // namespace

SequenceListing list_folder(const std::string& folder, const SequenceOptions& options) {
  namespace fs = std::filesystem;
  SequenceListing listing;
  listing.name = folder_name(folder);
  const auto images = list_images(in_folder(folder, "images"), listing);
  if (!use_explicit_calibration(folder, options, listing)) {
    listing.calibration_source = in_folder(folder, "K.txt");
    const bool made_up = !options.needs_calibration && !fs::exists(listing.calibration_source);
    listing.camera = made_up ? made_up_camera(image_size(images))
                             : read_intrinsics(listing.calibration_source, image_size(images));
  }
  const bool has_depth = fs::is_directory(in_folder(folder, "depth"));
  for (std::size_t i = 0; i < images.size(); ++i) {
    listing.frames.push_back(
        {static_cast<double>(i) / listing.camera.fps, images[i].string(),
         has_depth ? depth_file(folder, images[i].stem().string()) : std::string()});
  }
  const std::string poses = in_folder(folder, "poses.txt");
  if (fs::exists(poses)) {
    take_truth(listing, [&] {
      Trajectory truth;
      for (const SE3& pose : read_poses(poses, images.size())) {
        truth.push_back({listing.frames[truth.size()].stamp, pose});
      }
      return truth;
    });
  }
  return listing;
}

}  // namespace dxslam
