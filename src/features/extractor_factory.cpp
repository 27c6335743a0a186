// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/extractor_factory.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "core/error.h"
#include "features/data_directory.h"
#include "features/hand_crafted/brief_extractor.h"
#include "features/hand_crafted/orb_extractor.h"
#include "features/network/model_manifest.h"
#include "features/network/network_extractor.h"

namespace dxslam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kShipped = "hfnet";
constexpr const char* kUpright = "+brief";
constexpr const char* kTurned = "+rbrief";

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// The manifest that a name stands for; empty where there is none.
std::string find_manifest(const std::string& name) {
  if (ends_with(name, ".yaml")) return name;
  const fs::path data = data_directory();
  const fs::path shipped = data / "models" / name / "manifest.yaml";
  if (fs::exists(shipped)) return shipped.string();
  const fs::path described = data / "manifests" / (name + ".yaml");
  return fs::exists(described) ? described.string() : std::string();
}

[[noreturn]] void refuse_name(const std::string& name) {
  throw InputError(
      fmt::format("unknown features `{}`, expected a manifest (*.yaml) or one of: "
                  "{}; each also with +brief or +rbrief",
                  name, fmt::join(known_extractors(), ", ")));
}

/// The suffix for BRIEF descriptors that a name ends with; "" without.
const char* brief_suffix(const std::string& name) {
  for (const char* suffix : {kUpright, kTurned}) {
    if (ends_with(name, suffix)) return suffix;
  }
  return "";
}

std::unique_ptr<FeatureExtractor> make_plain(const std::string& name,
                                             const ExtractorOptions& options) {
  if (name == "orb") return make_orb_extractor(options);
  if (name == "opencv_orb") return make_opencv_orb_extractor(options);
  const std::string manifest = find_manifest(name);
  if (manifest.empty()) refuse_name(name);
  return make_network_extractor(read_model_manifest(manifest), options);
}

bool files_exist(const ModelVariants& variants) {
  return fs::exists(variants.floating.path) &&
         (!variants.int8.given() || fs::exists(variants.int8.path));
}

bool is_available(const std::string& name) {
  const std::string path = find_manifest(name);
  if (path.empty()) return true;
  const ModelManifest manifest = read_model_manifest(path);
  return files_exist(manifest.files) &&
         (!manifest.global_head || files_exist(manifest.global_head->files));
}

}  // namespace

std::unique_ptr<FeatureExtractor> make_extractor(const std::string& name_or_manifest,
                                                 const ExtractorOptions& options) {
  validate_options("features", options);
  const std::string_view suffix = brief_suffix(name_or_manifest);
  if (suffix.empty()) return make_plain(name_or_manifest, options);
  const auto detector = name_or_manifest.substr(0, name_or_manifest.size() - suffix.size());
  return make_brief_extractor(make_plain(detector, options), suffix == kTurned);
}

void require_known_extractor(const std::string& name_or_manifest) {
  const std::string_view suffix = brief_suffix(name_or_manifest);
  const std::string name = name_or_manifest.substr(0, name_or_manifest.size() - suffix.size());
  if (name == "orb" || name == "opencv_orb") return;
  if (find_manifest(name).empty()) refuse_name(name);
}

ExtractorChoice choose_extractor() {
  const std::string manifest = find_manifest(kShipped);
  if (!manifest.empty() && is_available(kShipped)) return {kShipped, ""};
  const std::string place = (fs::path(data_directory()) / "models" / kShipped).string();
  if (is_data_directory_chosen()) {
    throw InputError(fmt::format(
        "DXSLAM_DATA is {}, expected the folder with the network `{}`: no such files in {}",
        data_directory(), kShipped, place));
  }
  return {"orb",
          fmt::format("features are `orb`, less accurate: the files of the network `{}` were "
                      "not found in {}; DXSLAM_DATA may name the folder above models/",
                      kShipped, place)};
}

std::vector<std::string> known_extractors() {
  std::vector<std::string> models;
  std::error_code error;
  for (const auto& entry :
       fs::directory_iterator(fs::path(data_directory()) / "manifests", error)) {
    if (entry.path().extension() == ".yaml") models.push_back(entry.path().stem().string());
  }
  for (const auto& entry : fs::directory_iterator(fs::path(data_directory()) / "models", error)) {
    if (fs::exists(entry.path() / "manifest.yaml")) {
      models.push_back(entry.path().filename().string());
    }
  }
  std::sort(models.begin(), models.end());
  models.erase(std::unique(models.begin(), models.end()), models.end());
  std::vector<std::string> names{"orb", "opencv_orb"};
  names.insert(names.end(), models.begin(), models.end());
  return names;
}

std::vector<std::string> available_extractors() {
  std::vector<std::string> names = known_extractors();
  names.erase(std::remove_if(names.begin(), names.end(),
                             [](const std::string& name) { return !is_available(name); }),
              names.end());
  return names;
}

}  // namespace dxslam
