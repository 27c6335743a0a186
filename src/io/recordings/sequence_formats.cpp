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
    use_depth_camera(calibration.depth_camera, listing);
  }
  const bool preset = source.find_first_of("/.") == std::string::npos;
  listing.calibration_source = preset ? "preset " + source : source;
  return true;
}

void use_depth_camera(const DepthCamera& depth_camera, SequenceListing& listing) {
  DepthRegistration registration(listing.camera, depth_camera);
  listing.raw_depth_size = registration.raw_size();
  listing.register_depth = std::move(registration);
}

void take_truth(SequenceListing& listing, const std::function<Trajectory()>& read) {
  try {
    listing.ground_truth = read();
  } catch (const InputError& e) {
    listing.truth_problem = e.what();
    listing.notes.push_back(fmt::format("the true trajectory is not used: {}", e.what()));
  }
}

}  // namespace dxslam
