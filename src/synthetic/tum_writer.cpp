// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/tum_writer.h"

#include <fmt/format.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <regex>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "io/calibration/calibration.h"
#include "io/formats/trajectory_file.h"
#include "io/primitives/atomic_file.h"
#include "io/primitives/image_file.h"
#include "io/primitives/json_text.h"

namespace dxslam {
namespace {

namespace fs = std::filesystem;

/// Visitor that puts the described options into a JSON object.
class JsonVisitor {
 public:
  void operator()(OptionName name, const bool& value, const char*, const char*) {
    json[name.text] = value;
  }
  void operator()(OptionName name, const std::string& value, const char*, const char*) {
    json[name.text] = value;
  }
  template <class Number>
  void operator()(OptionName name, const Number& value, Range, const char*, const char*) {
    json[name.text] = value;
  }
  template <class Options>
  void group(const char* name, const Options& options) {
    JsonVisitor nested;
    Options::describe(options, nested);
    json[name] = nested.json;
  }
  nlohmann::ordered_json json;
};

constexpr const char* kScene = "scene.json";

// Whether the folder has the scene.json that write_tum_sequence() makes first of all.
bool is_made_here(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_regular_file(folder / kScene, error)) return false;  // a pipe would be waited for
  std::ifstream file(folder / kScene, std::ios::binary);
  const auto scene = nlohmann::json::parse(file, nullptr, false);
  return scene.is_object() && scene.contains("options") && scene.contains("path_length_m") &&
         scene["options"].is_object() && scene["options"].contains("scene");
}

// As write_frame() names them.
bool is_image_name(const std::string& name) {
  static const std::regex kImage(R"(\d+\.\d{6}\.(png|jpg))");
  return std::regex_match(name, kImage);
}

// A file in the folders of images that was not drawn here; empty if there is none.
std::string foreign_image(const fs::path& folder) {
  for (const char* images : {"rgb", "depth"}) {
    std::error_code error;
    for (fs::directory_iterator it(folder / images, error), end; !error && it != end;
         it.increment(error)) {
      const fs::path& path = it->path();
      const bool ours = is_image_name(path.filename().string()) &&
                        fs::symlink_status(path, error).type() == fs::file_type::regular;
      if (!ours) return (fs::path(images) / path.filename()).string();
    }
  }
  return {};
}

void prepare_folder(const fs::path& folder, bool overwrite) {
  require_usable_folder(folder.string(), overwrite);
  std::error_code error;
  // Only what is written here; anything else in the folder stays. The mark goes last.
  if (is_made_here(folder)) {
    for (const char* name :
         {"rgb.txt", "depth.txt", "groundtruth.txt", "calibration.yaml", "rgb", "depth", kScene}) {
      fs::remove_all(folder / name, error);
    }
  }
  for (const char* name : {"rgb", "depth"}) {
    fs::create_directories(folder / name, error);
    if (error) {
      throw InputError(
          fmt::format("cannot create folder '{}': {}", (folder / name).string(), error.message()));
    }
  }
}

// Not atomically: flushing thousands of images to the disk takes minutes, and the lists that name
// them are written last.
void write_image(const fs::path& path, const cv::Mat& image) {
  const std::string bytes = encode_image(path.string(), image);
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) {
    throw InputError(
        fmt::format("cannot write image '{}' (full disk or no permission?)", path.string()));
  }
}

std::string list_of(const SyntheticSequence& sequence, const std::vector<char>& drawn,
                    const std::string& folder, const std::string& type) {
  std::string text = fmt::format("# {} images, stamp in seconds and file\n", folder);
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    if (drawn[i] == 0) continue;
    const double stamp = sequence.stamp(i);
    text += fmt::format("{0:.6f} {1}/{0:.6f}.{2}\n", stamp, folder, type);
  }
  return text;
}

void write_frame(const RgbdImage& image, const fs::path& folder, double depth_factor,
                 const std::string& type) {
  const std::string stem = fmt::format("{:.6f}", image.stamp);
  write_image(folder / "rgb" / (stem + "." + type), image.color);
  cv::Mat raw;
  image.depth.convertTo(raw, CV_16UC1, depth_factor);
  write_image(folder / "depth" / (stem + ".png"), raw);
}

}  // namespace

void require_usable_folder(const std::string& folder, bool overwrite) {
  std::error_code error;
  if (!fs::exists(folder, error)) return;
  if (!fs::is_directory(folder, error)) {
    throw InputError(fmt::format("'{}' is a file, expected a folder to write to", folder));
  }
  const bool is_empty = fs::is_empty(folder, error);
  if (error) {
    throw InputError(fmt::format("folder '{}' cannot be read: {}", folder, error.message()));
  }
  if (is_empty) return;
  if (!overwrite) {
    throw InputError(
        fmt::format("folder '{}' is not empty, expected a new or empty one (--force "
                    "replaces an earlier recording)",
                    folder));
  }
  if (!is_made_here(folder)) {
    throw InputError(
        fmt::format("folder '{}' holds other files, expected a new or empty one, or a recording "
                    "with the {} that synth wrote",
                    folder, kScene));
  }
  if (const std::string foreign = foreign_image(folder); !foreign.empty()) {
    throw InputError(
        fmt::format("folder '{}' holds {}, which synth did not draw, expected only its own images",
                    folder, foreign));
  }
}

std::string describe_scene(const SyntheticSequence& sequence) {
  JsonVisitor visitor;
  SyntheticOptions::describe(sequence.options(), visitor);
  nlohmann::ordered_json scene;
  scene["options"] = visitor.json;
  scene["options"].erase("threads");  // has no influence
  scene["frames"] = sequence.size();
  scene["duration_s"] = sequence.ground_truth().back().stamp;
  scene["path_length_m"] = sequence.path_length();
  scene["surfaces"] = sequence.world().surfaces.size();
  scene["things"] = sequence.layout().placements.size();
  return to_json_text(scene);
}

bool write_tum_sequence(const SyntheticSequence& sequence, const std::string& folder,
                        const TumWriterOptions& options) {
  const fs::path root(folder);
  prepare_folder(root, options.overwrite);
  const std::string type = options.png ? "png" : "jpg";
  const auto path = [&](const char* name) { return (root / name).string(); };
  write_file_atomically(path(kScene), describe_scene(sequence));
  std::vector<char> drawn(sequence.size(), 0);
  std::atomic<bool> stop{false};
  std::mutex mutex;
  std::size_t done = 0;
  in_parallel(sequence.size(), options.threads, [&](std::size_t i) {
    if (stop) return;
    write_frame(sequence.draw(i, 1), root, sequence.camera().depth_factor, type);
    const std::lock_guard lock(mutex);
    ++done;
    drawn[i] = 1;
    if (options.progress && !options.progress(done, sequence.size())) stop = true;
  });
  if (done == 0) return false;
  write_file_atomically(path("calibration.yaml"),
                        dump_camera(sequence.camera(), "synthetic camera"));
  write_trajectory(path("groundtruth.txt"), sequence.ground_truth());
  write_file_atomically(path("depth.txt"), list_of(sequence, drawn, "depth", "png"));
  write_file_atomically(path("rgb.txt"), list_of(sequence, drawn, "rgb", type));
  return done == sequence.size();
}

}  // namespace dxslam
