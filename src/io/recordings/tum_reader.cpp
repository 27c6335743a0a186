// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <filesystem>
#include <regex>

#include "core/error.h"
#include "io/calibration/calibration.h"
#include "io/formats/trajectory_file.h"
#include "io/recordings/sequence_formats.h"

namespace dxslam {
namespace {

// The camera of a benchmark's sequence by its name: "rgbd_dataset_freiburg1_desk" as downloaded,
// "fr1_desk" or "tum_fr1_desk" as everybody calls them. Nothing for a name that only holds such
// letters somewhere, as "d435_fr30" does.
std::string preset_of(const std::string& name) {
  static const std::regex kName("(rgbd_dataset_|tum[_-])?(freiburg|fr)([123])([_-].*)?",
                                std::regex::icase);
  constexpr std::size_t kLongestName = 255;  // std::regex recurses over the length
  std::smatch match;
  if (name.size() > kLongestName || !std::regex_match(name, match, kName)) return {};
  return "tum_fr" + match[3].str();
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
          "{}: no calibration: the folder has no calibration.yaml, and its name is not that of a "
          "sequence of TUM's cameras (rgbd_dataset_freiburg1_... or fr1_..., 1 to 3); expected "
          "--calibration with a preset or a YAML file",
          folder));
    }
    listing.camera = load_camera(preset);
    listing.calibration_source = fmt::format("preset {} (by the folder's name)", preset);
    listing.notes.push_back(
        fmt::format("the camera is guessed from the folder's name: preset {}; --calibration or a "
                    "calibration.yaml in the folder says another one",
                    preset));
  }
  const std::string truth = in_folder(folder, "groundtruth.txt");
  if (std::filesystem::exists(truth)) {
    take_truth(listing, [&] { return read_trajectory(truth); });
  }
  return listing;
}

}  // namespace dxslam
