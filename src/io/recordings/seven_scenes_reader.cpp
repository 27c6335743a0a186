// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "core/error.h"
#include "io/calibration/calibration.h"
#include "io/formats/pose_matrix.h"
#include "io/primitives/text_file.h"
#include "io/recordings/sequence_formats.h"

namespace dxslam {
namespace {

constexpr double kDepthFocalLength = 585.0;  // pixels, of the Kinect's depth camera
constexpr double kFps = 30.0;
constexpr std::uint16_t kInvalidDepth = 65535;  // besides 0
constexpr std::size_t kNumberDigits = 6;
constexpr std::string_view kPrefix = "frame-";

// NNNNNN of "frame-NNNNNN.color.png" or ".color.jpg"; -1 for other names.
int frame_number(const std::string& name) {
  const std::size_t digits_end = kPrefix.size() + kNumberDigits;
  if (name.size() <= digits_end || name.compare(0, kPrefix.size(), kPrefix) != 0) return -1;
  const std::string ending = name.substr(digits_end);
  if (ending != ".color.png" && ending != ".color.jpg") return -1;
  int number = 0;
  for (const char c : name.substr(kPrefix.size(), kNumberDigits)) {
    if (c < '0' || c > '9') return -1;
    number = 10 * number + (c - '0');
  }
  return number;
}

SE3 read_pose(const std::string& path) {
  const std::vector<TextRow> rows = read_table(path, "a 4x4 pose");
  double values[16] = {};
  std::size_t count = 0;
  for (const TextRow& row : rows) {
    for (std::size_t i = 0; i < row.fields.size(); ++i, ++count) {
      if (count < 16) values[count] = finite_field(path, row, i, "pose element");
    }
  }
  if (count != 16) throw InputError(fmt::format("{}: {} numbers, expected 4x4", path, count));
  return pose_from_row_major(values, path);
}

// Column or row of the depth image for each one of the colour image, -1 where it lies outside.
// What every user of 7-Scenes does in want of a published calibration: both cameras in one place,
// the same centre, so that only the focal lengths matter.
std::vector<int> depth_indices(int size, double centre, double ratio) {
  std::vector<int> indices(static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i) {
    const double source = std::nearbyint((i - centre) * ratio + centre);
    indices[static_cast<std::size_t>(i)] =
        source >= 0 && source < size ? static_cast<int>(source) : -1;
  }
  return indices;
}

cv::Mat register_depth(const cv::Mat& raw, const std::vector<int>& rows,
                       const std::vector<int>& columns) {
  cv::Mat registered(raw.size(), CV_16UC1, cv::Scalar(0));
  for (int y = 0; y < raw.rows; ++y) {
    const int source_y = rows[static_cast<std::size_t>(y)];
    if (source_y < 0) continue;
    const auto* source = raw.ptr<std::uint16_t>(source_y);
    auto* target = registered.ptr<std::uint16_t>(y);
    for (int x = 0; x < raw.cols; ++x) {
      const int source_x = columns[static_cast<std::size_t>(x)];
      if (source_x >= 0 && source[source_x] != kInvalidDepth) target[x] = source[source_x];
    }
  }
  return registered;
}

std::map<int, std::string> find_frames(const std::string& folder, SequenceListing& listing) {
  std::map<int, std::string> colors;
  std::size_t others = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const int number = frame_number(name);
    if (number < 0 && name.find(".color.") != std::string::npos && name.front() != '.') ++others;
    if (number < 0) continue;
    if (!colors.emplace(number, name).second) {
      throw InputError(fmt::format("{}: both a PNG and a JPEG for frame {}, expected one of them",
                                   folder, number));
    }
  }
  if (others > 0) {
    listing.notes.push_back(fmt::format(
        "{} colour images were left out, as they are not called frame-NNNNNN.color.png or .jpg",
        others));
  }
  return colors;
}

// A frame whose pose cannot be read is one without.
void take_pose(double stamp, const std::string& path, SequenceListing& listing,
               std::size_t& broken) {
  try {
    listing.ground_truth.push_back({stamp, read_pose(path)});
  } catch (const InputError& e) {
    if (broken++ == 0) listing.truth_problem = e.what();
  }
}

}  // namespace

bool has_seven_scenes_frames(const std::string& folder) {
  std::error_code error;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    if (frame_number(it->path().filename().string()) >= 0) return true;
  }
  return false;
}

SequenceListing list_seven_scenes(const std::string& folder, const SequenceOptions& options) {
  SequenceListing listing;
  listing.name = folder_name(folder);
  if (!use_explicit_calibration(folder, options, listing)) {
    listing.camera = load_camera("seven_scenes");
    listing.calibration_source = "preset seven_scenes (by the format)";
  }
  std::size_t broken_poses = 0;
  for (const auto& [number, color] : find_frames(folder, listing)) {
    const double stamp = number / kFps;
    const std::string stem = in_folder(folder, color.substr(0, kPrefix.size() + kNumberDigits));
    listing.frames.push_back({stamp, in_folder(folder, color), stem + ".depth.png"});
    const std::string pose = stem + ".pose.txt";
    if (std::filesystem::exists(pose)) take_pose(stamp, pose, listing, broken_poses);
  }
  if (broken_poses > 0) {
    listing.notes.push_back(fmt::format("{} frames are without a true pose; the first: {}",
                                        broken_poses, listing.truth_problem));
  }
  if (listing.frames.empty()) {
    throw InputError(
        fmt::format("{}: no frame in it, expected frame-NNNNNN.color.png or .color.jpg", folder));
  }
  if (listing.register_depth) return listing;  // by a calibration with the depth camera's place
  const Camera& camera = listing.camera;
  const auto rows = depth_indices(camera.height, camera.cy, kDepthFocalLength / camera.fy);
  const auto columns = depth_indices(camera.width, camera.cx, kDepthFocalLength / camera.fx);
  listing.register_depth = [rows, columns](const cv::Mat& raw) {
    return register_depth(raw, rows, columns);
  };
  return listing;
}

}  // namespace dxslam
