// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <optional>

#include "core/error.h"
#include "io/calibration/calibration.h"
#include "io/formats/pose_matrix.h"
#include "io/formats/trajectory_file.h"
#include "io/primitives/text_file.h"
#include "io/primitives/yaml_text.h"
#include "io/recordings/openloris_sensors.h"
#include "io/recordings/sequence_formats.h"

namespace dxslam {
namespace {

constexpr const char* kColorFrame = "d400_color_optical_frame";
constexpr const char* kBaseFrame = "base_link";

YAML::Node load_opencv_yaml(const std::string& path) {
  return parse_opencv_yaml(read_file(path, "a YAML file of OpenLORIS-Scene", limits::kYamlBytes),
                           path);
}

// `count` finite numbers of the "data" list of an OpenCV matrix.
std::vector<double> matrix_data(const YAML::Node& matrix, std::size_t count,
                                const std::string& path, const std::string& what) {
  const auto values = finite_numbers(yaml_child(matrix, "data"));
  if (values && values->size() == count) return *values;
  throw InputError(fmt::format("{}: {} has no list of {} finite numbers", path, what, count));
}

double scalar(const YAML::Node& map, const char* key, const std::string& path) {
  const auto value = parse_number(yaml_scalar(yaml_child(map, key)));
  if (value && std::isfinite(*value)) return *value;
  throw InputError(fmt::format("{}: {} of {} is missing or no number", path, key, kColorFrame));
}

// Intrinsics of the colour camera: fx cx fy cy, then k1 k2 p1 p2 k3.
void read_sensors(const std::string& path, Camera& camera) {
  const YAML::Node sensor = yaml_child(load_opencv_yaml(path), kColorFrame);
  if (!sensor.IsDefined() || !sensor.IsMap()) {
    throw InputError(fmt::format("{}: no sensor {} in it", path, kColorFrame));
  }
  const auto pinhole = matrix_data(yaml_child(sensor, "intrinsics"), 4, path, "intrinsics");
  camera.width = static_cast<int>(std::clamp(scalar(sensor, "width", path), 0.0, 1e6));
  camera.height = static_cast<int>(std::clamp(scalar(sensor, "height", path), 0.0, 1e6));
  camera.fps = scalar(sensor, "fps", path);
  camera.fx = pinhole[0];
  camera.cx = pinhole[1];
  camera.fy = pinhole[2];
  camera.cy = pinhole[3];
  const YAML::Node coefficients = yaml_child(sensor, "distortion_coefficients");
  if (!coefficients.IsDefined() || coefficients.IsNull()) return;
  const auto distortion = matrix_data(coefficients, 5, path, "distortion_coefficients");
  std::copy(distortion.begin(), distortion.end(), camera.lens.parameters.begin());
}

std::optional<SE3> read_base_from_color(const std::string& path) {
  const YAML::Node list = yaml_child(load_opencv_yaml(path), "trans_matrix");
  if (!list.IsDefined() || !list.IsSequence()) {
    throw InputError(fmt::format("{}: no list trans_matrix in it", path));
  }
  for (const YAML::Node& item : list) {
    if (yaml_scalar(yaml_child(item, "parent_frame")) != kBaseFrame ||
        yaml_scalar(yaml_child(item, "child_frame")) != kColorFrame) {
      continue;
    }
    const auto data =
        matrix_data(yaml_child(item, "matrix"), 16, path, "matrix of the colour camera");
    double values[16];
    std::copy(data.begin(), data.end(), values);
    return pose_from_row_major(values, at_line(path, yaml_line(item.Mark())));
  }
  return std::nullopt;
}

void calibrate(const std::string& folder, bool market, const SequenceOptions& options,
               SequenceListing& listing) {
  if (use_explicit_calibration(folder, options, listing)) return;
  const std::string sensors = in_folder(folder, "sensors.yaml");
  const bool has_sensors = std::filesystem::exists(sensors);
  if (market && !has_sensors) {
    throw InputError(
        fmt::format("{}: no calibration: market was recorded with a camera of its own, expected "
                    "sensors.yaml in "
                    "the folder or --calibration",
                    folder));
  }
  listing.camera = load_camera("openloris_d435i");
  listing.calibration_source = has_sensors ? sensors : "preset openloris_d435i (by the format)";
  if (has_sensors) return read_sensors(sensors, listing.camera);
  listing.notes.push_back(
      "no sensors.yaml: the camera is taken to be that of the robot of OpenLORIS-Scene "
      "(preset openloris_d435i)");
}

// Where the camera is on the robot: of the recording, or as published with the dataset.
SE3 find_base_from_color(const std::string& folder, bool market, SequenceListing& listing) {
  const std::string transforms = in_folder(folder, "trans_matrix.yaml");
  if (std::filesystem::exists(transforms)) {
    if (const auto found = read_base_from_color(transforms)) return *found;
  }
  listing.notes.push_back(fmt::format(
      "no trans_matrix.yaml with {}: the true poses are moved to the camera as published for {}",
      kColorFrame, market ? "market" : "all scenes but market"));
  return openloris_base_from_sensor(market, "d400_color");
}

// "market1-1" is one, "supermarket" is not.
bool is_market(const std::string& name) {
  const std::size_t at = name.find("market");
  return at != std::string::npos &&
         (at == 0 || std::isalpha(static_cast<unsigned char>(name[at - 1])) == 0);
}

}  // namespace

SequenceListing list_openloris(const std::string& folder, const SequenceOptions& options) {
  SequenceListing listing;
  listing.name = folder_name(folder);
  associate_lists(folder, "color.txt", "aligned_depth.txt", options, listing);
  const bool market = is_market(listing.name);
  calibrate(folder, market, options, listing);

  const std::string truth = in_folder(folder, "groundtruth.txt");
  if (!std::filesystem::exists(truth)) return listing;
  take_truth(listing, [&] {
    const SE3 base_from_color = find_base_from_color(folder, market, listing);
    Trajectory moved;
    for (const StampedPose& pose : read_trajectory(truth)) {
      moved.push_back({pose.stamp, pose.world_from_camera * base_from_color});
    }
    return moved;
  });
  return listing;
}

}  // namespace dxslam
