// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/recordings/sequence_formats.h"

#include <fmt/format.h>

#include <filesystem>

#include "core/error.h"
#include "io/calibration/calibration.h"

namespace dxslam {

std::string in_folder(const std::string& folder, const std::string& name) {
  return (std::filesystem::path(folder) / name).string();
}

std::string folder_name(const std::string& folder) {
  const std::filesystem::path path = std::filesystem::absolute(folder).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

bool use_explicit_calibration(const std::string& folder, const SequenceOptions& options,
                              SequenceListing& listing) {
  std::string source = options.calibration;
  for (const char* name : {"calibration.yaml", "camera.yaml"}) {
    const std::string own = in_folder(folder, name);
    if (!options.calibration.empty() || !std::filesystem::exists(own)) continue;
    if (source.empty()) {
      source = own;
    } else {
      listing.notes.push_back(fmt::format("{} is used, {} is not", source, own));
    }
  }
  if (source.empty()) return false;
  const RgbdCalibration calibration = load_calibration(source);
  listing.camera = calibration.camera;
  if (!calibration.depth_camera.registered()) {
    listing.register_depth = DepthRegistration(listing.camera, calibration.depth_camera);
  }
  const bool preset = source.find_first_of("/.") == std::string::npos;
  listing.calibration_source = preset ? "preset " + source : source;
  return true;
}

void take_truth(SequenceListing& listing, const std::function<Trajectory()>& read) {
  try {
    listing.ground_truth = read();
  } catch (const InputError& e) {
    listing.truth_problem = e.what();
    listing.notes.push_back(fmt::format("the true trajectory is not used: {}", e.what()));
  }
}

SE3 pose_from_row_major(const double (&values)[16], const std::string& where) {
  Eigen::Matrix4d matrix;
  for (int i = 0; i < 16; ++i) matrix(i / 4, i % 4) = values[i];
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  const double skewness =
      (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(skewness <= 0.01) || rotation.determinant() < 0.0) {
    throw InputError(fmt::format("{}: rotation part is off orthonormal by {:.3g}, expected a pose",
                                 where, skewness));
  }
  if ((matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > 1e-6) {
    throw InputError(fmt::format("{}: last row of the pose is not 0 0 0 1", where));
  }
  return {Eigen::Quaterniond(rotation), Eigen::Vector3d(matrix.topRightCorner<3, 1>())};
}

}  // namespace dxslam
