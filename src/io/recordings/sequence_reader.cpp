// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/recordings/sequence_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/error.h"
#include "io/bags/bag_file.h"
#include "io/primitives/image_listing.h"
#include "io/primitives/name_order.h"
#include "io/primitives/text_file.h"
#include "io/recordings/sequence_formats.h"

namespace dxslam {
namespace {

namespace fs = std::filesystem;

// Which options have a meaning.
enum class Has { kNothing, kLists, kCameras, kTopics };

/// All that programs say of a format, and do with it, comes from its row.
struct Format {
  const char* name;
  const char* holds;  // what it is known by, for messages
  bool (*recognises)(const std::string& path);
  SequenceListing (*list)(const std::string& path, const SequenceOptions& options);
  Has has = Has::kNothing;
  bool yields = false;   // only where no other recognises the folder
  bool is_file = false;  // may be one
};

bool has(const std::string& folder, const char* name) {
  std::error_code error;
  return fs::exists(in_folder(folder, name), error);
}

const std::vector<Format>& formats() {
  static const std::vector<Format> table = {
      {"tum", "rgb.txt and depth.txt", [](const std::string& f) { return has(f, "rgb.txt"); },
       list_tum, Has::kLists},
      {"7scenes", "frame-NNNNNN.color.png", has_seven_scenes_frames, list_seven_scenes},
      {"openloris", "color.txt and aligned_depth.txt",
       [](const std::string& f) { return has(f, "color.txt"); }, list_openloris, Has::kLists},
      {"kitti", "times.txt and calib.txt",
       [](const std::string& f) { return has(f, "times.txt") && has(f, "calib.txt"); }, list_kitti,
       Has::kCameras},
      {"folder", "images/ and K.txt", [](const std::string& f) { return has(f, "images"); },
       list_folder},
      {"bag", "a .bag, .mcap or .db3 file", is_bag, list_bag, Has::kTopics, true, true},
      {"images", "image files", nullptr, list_image_folder, Has::kCameras},
  };
  return table;
}

// "lists of images (tum, openloris)": `what`, and the formats that have it.
std::string described(const char* what, Has has) {
  std::vector<std::string> names;
  for (const Format& format : formats()) {
    if (format.has == has) names.emplace_back(format.name);
  }
  return fmt::format("{} ({})", what, fmt::join(names, ", "));
}

const Format& format_named(const std::string& name) {
  for (const Format& format : formats()) {
    if (name == format.name) return format;
  }
  throw InputError(fmt::format("no sequence format {}, expected one of {}", in_quotes(name),
                               sequence_format_list()));
}

/// Where a recording lies, and in which format.
struct Place {
  std::string folder;
  const Format* format = nullptr;
};

// The format that `folder` itself looks like, `wanted` or any; none where it looks like no
// recording.
const Format* recognise(const std::string& folder, const Format* wanted) {
  const Format* found = nullptr;
  for (const Format& format : formats()) {
    if (format.recognises == nullptr || !format.recognises(folder)) continue;
    if (wanted != nullptr && wanted != &format) continue;
    if (found != nullptr && format.yields) continue;
    if (found != nullptr) {
      throw InputError(fmt::format("{}: looks like both {} and {}, expected --format to say which",
                                   folder, found->name, format.name));
    }
    found = &format;
  }
  return found;
}

// Recordings in the subfolders. Folders of mere images are none: depth images lie in such, too.
std::vector<Place> recordings_below(const std::string& folder, const Format* wanted) {
  std::vector<Place> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    std::error_code error;
    const std::string name = entry.path().filename().string();
    if (!entry.is_directory(error) || error || name.front() == '.') continue;
    const Format* format = recognise(entry.path().string(), wanted);
    if (format != nullptr) found.push_back({entry.path().string(), format});
  }
  std::sort(found.begin(), found.end(),
            [](const Place& a, const Place& b) { return natural_less(a.folder, b.folder); });
  return found;
}

[[noreturn]] void refuse_folder(const std::string& folder, const std::vector<Place>& below) {
  if (below.size() > 1) {
    throw InputError(fmt::format(
        "{}: no recording itself, but {} of its subfolders are ({} and {}{}), expected one of them",
        folder, below.size(), folder_name(below[0].folder), folder_name(below[1].folder),
        below.size() > 2 ? ", ..." : ""));
  }
  throw InputError(
      fmt::format("{}: not a recording known here, expected {}", folder, known_recordings()));
}

// The format of a recording that is one file.
Place file_place(const std::string& path, const Format* wanted) {
  for (const Format& format : formats()) {
    if (!format.is_file || !format.recognises(path)) continue;
    if (wanted == nullptr || wanted == &format) return {path, &format};
    throw InputError(
        fmt::format("{}: not a folder, expected one for format {}", path, wanted->name));
  }
  refuse_folder(path, {});
}

// The recording in `path`, or the only one in its subfolders.
Place find_recording(const std::string& path, const std::string& format) {
  if (!fs::exists(path)) {
    throw InputError(fmt::format("{}: no such file or folder, expected a recording", path));
  }
  const Format* wanted = format == "auto" ? nullptr : &format_named(format);
  if (!fs::is_directory(path)) return file_place(path, wanted);
  if (const Format* found = recognise(path, wanted)) return {path, found};
  const Format& images = format_named("images");
  if (wanted == &images) return {path, wanted};
  if (wanted == nullptr && (has_image_files(path) || has(path, "Images"))) return {path, &images};
  const std::vector<Place> below = recordings_below(path, wanted);
  if (below.size() == 1) return below.front();
  if (wanted == nullptr || below.size() > 1) refuse_folder(path, below);
  return {path, wanted};  // whose reader says what is missing
}

void refuse_unused_options(const Format& format, const SequenceOptions& options) {
  const auto check = [&](const char* option, bool given, Has needed, const char* what) {
    if (!given || format.has == needed) return;
    throw InputError(fmt::format("option {} is for {}, expected none for a recording of format {}",
                                 option, described(what, needed), format.name));
  };
  check("--association", !options.association.empty(), Has::kLists, "lists of images");
  check("--eye", options.eye != "all", Has::kCameras, "recordings of two cameras");
  check("--color-topic", !options.color_topic.empty(), Has::kTopics, "files of topics");
  check("--depth-topic", !options.depth_topic.empty(), Has::kTopics, "files of topics");
}

SequenceListing checked_listing(const std::string& path, const SequenceOptions& options) {
  if (!(options.max_association_s >= 0.0 && options.max_association_s <= 1e3)) {
    throw InputError(fmt::format("option max_association_s is {} s, expected 0 to 1000",
                                 options.max_association_s));
  }
  if (options.eye != "all" && options.eye != "left" && options.eye != "right") {
    throw InputError(
        fmt::format("option eye is {}, expected all, left or right", in_quotes(options.eye)));
  }
  const Place place = find_recording(path, options.format);
  refuse_unused_options(*place.format, options);
  SequenceListing listing = place.format->list(place.folder, options);
  if (place.folder != path) {
    listing.notes.insert(
        listing.notes.begin(),
        fmt::format("{} is no recording itself; the one in {} is used", path, place.folder));
  }
  return listing;
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

std::string sequence_format_list() {
  return fmt::format("auto, {}", fmt::join(sequence_formats(), ", "));
}

std::string known_recordings() {
  std::vector<std::string> known;
  for (const Format& format : formats()) {
    known.push_back(fmt::format("{} ({})", format.holds, format.name));
  }
  const std::string last = known.back();
  known.pop_back();
  return fmt::format("{} or {}", fmt::join(known, ", "), last);
}

SequenceListing list_sequence(const std::string& path, const SequenceOptions& options) {
  try {
    return checked_listing(path, options);
  } catch (const fs::filesystem_error& e) {
    throw InputError(fmt::format("{}: {}", e.path1().string(), e.code().message()));
  }
}

std::unique_ptr<RgbdSequence> open_sequence(const std::string& path,
                                            const SequenceOptions& options) {
  return make_sequence(list_sequence(path, options));
}

std::string recognised_format(const std::string& path, const std::string& wanted) {
  return find_recording(path, wanted).format->name;
}

void require_depth(const ImageOrigin& origin) {
  if (origin.facts().has_depth) return;
  throw InputError(fmt::format(
      "{}: the recording has no depth images, expected one beside each colour image (RGB-D)",
      origin.name()));
}

TrajectoryFile load_ground_truth(const std::string& file_or_folder, const std::string& format) {
  std::error_code error;
  if (!fs::is_directory(file_or_folder, error) && !is_bag(file_or_folder))
    return read_trajectory_file(file_or_folder, format);
  for (const char* euroc :
       {"state_groundtruth_estimate0/data.csv", "mav0/state_groundtruth_estimate0/data.csv"}) {
    const std::string file = in_folder(file_or_folder, euroc);
    if (fs::exists(file, error)) return read_trajectory_file(file, "euroc");
  }
  const std::unique_ptr<RgbdSequence> sequence = open_sequence(file_or_folder);
  if (!sequence->ground_truth().empty()) {
    return {sequence->ground_truth(), TrajectoryFormat::kTum, {}};
  }
  const std::string& problem = sequence->facts().truth_problem;
  throw InputError(
      problem.empty()
          ? fmt::format("{}: the recording has no true trajectory, expected one", file_or_folder)
          : problem);
}

}  // namespace dxslam
