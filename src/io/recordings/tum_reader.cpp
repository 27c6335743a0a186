// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <filesystem>

#include "core/error.h"
#include "io/calibration/calibration.h"
#include "io/formats/trajectory_file.h"
#include "io/recordings/sequence_formats.h"

namespace dxslam {
namespace {

// The benchmark's sequences carry the number of their camera in the name: "..._freiburg1_..." as
// downloaded, "fr1" as everybody calls them.
std::string preset_of(const std::string& name) {
  for (const char* camera : {"1", "2", "3"}) {
    for (const char* stem : {"freiburg", "fr"}) {
      if (name.find(std::string(stem) + camera) != std::string::npos) {
        return std::string("tum_fr") + camera;
      }
    }
  }
  return {};
}

}  // namespace

SequenceListing list_tum(const std::string& folder, const SequenceOptions& options) {
  SequenceListing listing;
  listing.name = folder_name(folder);
  associate_lists(folder, "rgb.txt", "depth.txt", options, listing);
  if (!use_explicit_calibration(folder, options, listing)) {
    const std::string preset = preset_of(listing.name);
    if (preset.empty()) {
      throw InputError(fmt::format(
          "{}: no calibration: the folder has no calibration.yaml and its name does not say "
          "freiburg1, 2 or 3; expected --calibration with a preset or a YAML file",
          folder));
    }
    listing.camera = load_camera(preset);
    listing.calibration_source = "preset " + preset;
  }
  const std::string truth = in_folder(folder, "groundtruth.txt");
  if (std::filesystem::exists(truth)) listing.ground_truth = read_trajectory(truth);
  return listing;
}

}  // namespace dxslam
