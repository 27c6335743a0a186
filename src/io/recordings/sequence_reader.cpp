// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/recordings/sequence_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/error.h"
#include "io/formats/trajectory_file.h"
#include "io/primitives/text_file.h"
#include "io/recordings/sequence_formats.h"

namespace dxslam {
namespace {

namespace fs = std::filesystem;

struct Format {
  const char* name;
  bool (*recognises)(const std::string& folder);  // none: only where no other does
  SequenceListing (*list)(const std::string& folder, const SequenceOptions& options);
};

bool has(const std::string& folder, const char* name) {
  std::error_code error;
  return fs::exists(in_folder(folder, name), error);
}

const std::vector<Format>& formats() {
  static const std::vector<Format> table = {
      {"tum", [](const std::string& f) { return has(f, "rgb.txt"); }, list_tum},
      {"7scenes", has_seven_scenes_frames, list_seven_scenes},
      {"openloris", [](const std::string& f) { return has(f, "color.txt"); }, list_openloris},
      {"kitti", [](const std::string& f) { return has(f, "times.txt") && has(f, "calib.txt"); },
       list_kitti},
      {"folder", [](const std::string& f) { return has(f, "images"); }, list_folder},
      {"images", nullptr, list_image_folder},
  };
  return table;
}

const Format& format_named(const std::string& name) {
  for (const Format& format : formats()) {
    if (name == format.name) return format;
  }
  throw InputError(fmt::format("no sequence format {}, expected auto, {}", in_quotes(name),
                               fmt::join(sequence_formats(), ", ")));
}

const Format& recognise(const std::string& folder) {
  const Format* found = nullptr;
  for (const Format& format : formats()) {
    if (format.recognises == nullptr || !format.recognises(folder)) continue;
    if (found != nullptr) {
      throw InputError(fmt::format("{}: looks like both {} and {}, expected --format to say which",
                                   folder, found->name, format.name));
    }
    found = &format;
  }
  if (found != nullptr) return *found;
  if (has_images(folder) || has(folder, "Images")) return format_named("images");
  throw InputError(
      fmt::format("{}: not a recording known here, expected rgb.txt and depth.txt (tum), "
                  "frame-NNNNNN.color.png "
                  "(7scenes), color.txt and aligned_depth.txt (openloris), images/ and K.txt "
                  "(folder), times.txt "
                  "and calib.txt (kitti) or image files (images){}",
                  folder, has(folder, "seq-01") ? "; its subfolder seq-01 may be one" : ""));
}

SequenceListing list_sequence(const std::string& path, const SequenceOptions& options) {
  if (!(options.max_association_s >= 0.0 && options.max_association_s <= 1e3)) {
    throw InputError(fmt::format("option max_association_s is {} s, expected 0 to 1000",
                                 options.max_association_s));
  }
  if (!fs::is_directory(path)) {
    throw InputError(fmt::format("{}: {}, expected the folder of a recording", path,
                                 fs::exists(path) ? "not a folder" : "no such folder"));
  }
  if (options.eye != "all" && options.eye != "left" && options.eye != "right") {
    throw InputError(
        fmt::format("option eye is {}, expected all, left or right", in_quotes(options.eye)));
  }
  const Format& format = options.format == "auto" ? recognise(path) : format_named(options.format);
  return format.list(path, options);
}

}  // namespace

const std::vector<std::string>& sequence_formats() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Format& format : formats()) all.emplace_back(format.name);
    return all;
  }();
  return names;
}

std::unique_ptr<RgbdSequence> open_sequence(const std::string& path,
                                            const SequenceOptions& options) {
  try {
    return make_sequence(list_sequence(path, options));
  } catch (const fs::filesystem_error& e) {
    throw InputError(fmt::format("{}: {}", e.path1().string(), e.code().message()));
  }
}

void require_depth(const RgbdSequence& sequence) {
  if (sequence.facts().has_depth) return;
  throw InputError(fmt::format(
      "{}: the recording has no depth images, expected one beside each colour image (RGB-D)",
      sequence.name()));
}

Trajectory load_ground_truth(const std::string& file_or_folder) {
  std::error_code error;
  if (!fs::is_directory(file_or_folder, error)) return read_trajectory(file_or_folder);
  Trajectory truth = open_sequence(file_or_folder)->ground_truth();
  if (truth.empty()) {
    throw InputError(
        fmt::format("{}: the recording has no true trajectory, expected one", file_or_folder));
  }
  return truth;
}

}  // namespace dxslam
