// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/model_manifest.h"

#include <fmt/format.h>

#include <filesystem>

#include "core/error.h"
#include "features/data_directory.h"
#include "features/sha256.h"
#include "features/strict_yaml.h"

namespace dxslam {
namespace {

namespace fs = std::filesystem;

constexpr int kFormat = 1;

TensorLayout read_layout(StrictMap& map) {
  const auto text = map.optional<std::string>("layout", "nchw");
  if (text == "nchw") return TensorLayout::kNchw;
  if (text == "nhwc") return TensorLayout::kNhwc;
  map.fail_at("layout", fmt::format("layout is `{}`, expected nchw or nhwc", text));
}

std::string read_hash(StrictMap& map, const std::string& key) {
  const auto hash = map.optional<std::string>(key, "");
  if (hash.empty() ||
      (hash.size() == 64 && hash.find_first_not_of("0123456789abcdef") == std::string::npos)) {
    return hash;
  }
  map.fail_at(key, fmt::format("{} is `{}`, expected 64 lower-case hexadecimal digits", key, hash));
}

ModelFile read_file(StrictMap map, const fs::path& folder) {
  ModelFile file;
  const fs::path path = expand_variables(map.required<std::string>("file"));
  file.path = (path.is_absolute() ? path : folder / path).lexically_normal().string();
  file.sha256 = read_hash(map, "sha256");
  file.weights_sha256 = read_hash(map, "weights_sha256");
  map.finish();
  return file;
}

ModelVariants read_variants(StrictMap map, const fs::path& folder) {
  ModelVariants variants;
  variants.floating = read_file(map.map("float"), folder);
  if (map.has("int8")) variants.int8 = read_file(map.map("int8"), folder);
  map.finish();
  return variants;
}

std::vector<double> read_per_channel(StrictMap& map, const std::string& key, int channels) {
  auto values = map.optional<std::vector<double>>(key, {});
  if (!values.empty() && values.size() != static_cast<std::size_t>(channels)) {
    map.fail_at(key, fmt::format("{} has {} numbers, expected {}, one a channel", key,
                                 values.size(), channels));
  }
  return values;
}

void read_normalization(StrictMap& map, InputDescription& input) {
  input.scale = map.optional<double>("scale", 1.0);
  if (!(input.scale > 0.0)) map.fail_at("scale", "scale must be above 0");
  input.mean = read_per_channel(map, "mean", input.channels);
  input.deviation = read_per_channel(map, "std", input.channels);
  for (const double deviation : input.deviation) {
    if (!(deviation > 0.0)) map.fail_at("std", "std must be above 0");
  }
  const auto normalization = map.optional<std::string>("normalization", "none");
  if (normalization != "none" && normalization != "instance") {
    map.fail_at("normalization",
                fmt::format("normalization is `{}`, expected none or instance", normalization));
  }
  input.instance_normalized = normalization == "instance";
}

InputDescription read_input(StrictMap map) {
  InputDescription input;
  input.name = map.required<std::string>("name");
  input.channels = map.required<int>("channels");
  if (input.channels != 1 && input.channels != 3) {
    map.fail_at("channels", fmt::format("channels is {}, expected 1 or 3", input.channels));
  }
  input.layout = read_layout(map);
  const auto color = map.optional<std::string>("color", "rgb");
  if (color != "rgb" && color != "bgr") {
    map.fail_at("color", fmt::format("color is `{}`, expected rgb or bgr", color));
  }
  input.bgr = color == "bgr";
  read_normalization(map, input);
  input.size_multiple = map.optional<int>("size_multiple", 32);
  if (input.size_multiple < 1 || input.size_multiple > 256) {
    map.fail_at("size_multiple",
                fmt::format("size_multiple is {}, expected 1 to 256", input.size_multiple));
  }
  if (map.has("fixed_size")) {
    const auto size = map.required<std::vector<int>>("fixed_size");
    if (size.size() != 2 || size[0] < 16 || size[1] < 16) {
      map.fail_at("fixed_size", "fixed_size must be [width, height], each at least 16 pixels");
    }
    input.fixed_width = size[0];
    input.fixed_height = size[1];
  }
  map.finish();
  return input;
}

std::optional<OutputDescription> read_output(StrictMap& outputs, const std::string& role) {
  if (!outputs.has(role)) return std::nullopt;
  StrictMap map = outputs.map(role);
  OutputDescription output;
  output.name = map.required<std::string>("name");
  output.layout = read_layout(map);
  map.finish();
  return output;
}

void read_outputs(StrictMap map, ModelManifest& manifest) {
  manifest.keypoint_logits = read_output(map, "keypoint_logits");
  manifest.scores = read_output(map, "scores");
  const auto descriptors = read_output(map, "descriptors");
  if (!descriptors) map.fail("outputs.descriptors is missing");
  manifest.descriptors = *descriptors;
  manifest.reliability = read_output(map, "reliability");
  manifest.features = read_output(map, "features");
  manifest.global = read_output(map, "global");
  const int sources = (manifest.keypoint_logits ? 1 : 0) + (manifest.scores ? 1 : 0) +
                      (manifest.detection_from_descriptors ? 1 : 0);
  if (sources != 1) {
    map.fail(
        fmt::format("found {} sources of keypoints, expected exactly one of "
                    "outputs.keypoint_logits, outputs.scores and "
                    "detection_from_descriptors: true",
                    sources));
  }
  map.finish();
}

void read_global(StrictMap& top, ModelManifest& manifest, const fs::path& folder) {
  if (top.has("global_head")) {
    StrictMap map = top.map("global_head");
    manifest.global_head = GlobalHeadDescription{read_variants(map.map("files"), folder),
                                                 map.required<std::string>("input"),
                                                 map.required<std::string>("output")};
    map.finish();
    if (!manifest.features) top.fail("global_head is given, but outputs.features is missing");
    if (manifest.global) top.fail("found both global_head and outputs.global, expected one");
  }
  manifest.global_dimension = top.optional<int>("global_dimension", 0);
  const bool has_global = manifest.global || manifest.global_head;
  if (has_global != (manifest.global_dimension > 0)) {
    top.fail(fmt::format("global_dimension is {}, expected {}", manifest.global_dimension,
                         has_global ? "the length of the global descriptor"
                                    : "none without outputs.global or global_head"));
  }
}

void read_detection(StrictMap& top, ModelManifest& manifest) {
  StrictMap detector = top.map("detector");
  manifest.cell_size = detector.optional<int>("cell_size", 8);
  if (manifest.cell_size < 2 || manifest.cell_size > 32) {
    detector.fail_at("cell_size", "detector.cell_size must be 2 to 32");
  }
  detector.read_options(manifest.detector);
  detector.finish();
  StrictMap descriptor = top.map("descriptor");
  descriptor.required<int>("dimension");
  descriptor.read_options(manifest.descriptor);
  descriptor.finish();
}

void check_size_multiple(const StrictMap& top, const ModelManifest& manifest) {
  const int multiple = manifest.input.size_multiple;
  if (manifest.keypoint_logits && multiple % manifest.cell_size != 0) {
    top.fail(fmt::format("input.size_multiple is {}, expected a multiple of detector.cell_size {}",
                         multiple, manifest.cell_size));
  }
  if (multiple % manifest.descriptor.stride != 0) {
    top.fail(fmt::format("input.size_multiple is {}, expected a multiple of descriptor.stride {}",
                         multiple, manifest.descriptor.stride));
  }
}

void verify_hash(const std::string& path, const std::string& expected) {
  if (expected.empty()) return;
  const std::string found = sha256_of_file(path);
  if (found == expected) return;
  throw InputError(
      fmt::format("{}: has SHA-256 {} ({} bytes), expected {}; it is truncated or "
                  "another version of the model",
                  path, found, fs::file_size(path), expected));
}

}  // namespace

ModelManifest read_model_manifest(const std::string& path) {
  StrictMap top = StrictMap::from_file(path);
  const int format = top.required<int>("format");
  if (format != kFormat) {
    top.fail_at("format", fmt::format("format is {}, expected {}", format, kFormat));
  }
  const fs::path folder = fs::path(path).parent_path();
  ModelManifest manifest;
  manifest.path = path;
  manifest.name = top.required<std::string>("name");
  manifest.description = top.required<std::string>("description");
  manifest.licence = top.required<std::string>("licence");
  manifest.files = read_variants(top.map("files"), folder);
  manifest.input = read_input(top.map("input"));
  manifest.detection_from_descriptors = top.optional<bool>("detection_from_descriptors", false);
  read_outputs(top.map("outputs"), manifest);
  read_global(top, manifest, folder);
  read_detection(top, manifest);
  check_size_multiple(top, manifest);
  top.ignore("info");
  top.finish();
  return manifest;
}

void verify_model_file(const ModelFile& file) {
  const fs::path path(file.path);
  if (!fs::exists(path)) {
    throw InputError(
        fmt::format("{}: no such file, expected a model (OpenVINO .xml, .onnx, or "
                    "TensorFlow .pb or saved model)",
                    file.path));
  }
  if (fs::is_regular_file(path)) verify_hash(file.path, file.sha256);
  if (path.extension() != ".xml") return;
  const std::string weights = fs::path(path).replace_extension(".bin").string();
  if (!fs::exists(weights)) {
    throw InputError(
        fmt::format("{}: no such file, expected the weights of {}", weights, file.path));
  }
  verify_hash(weights, file.weights_sha256);
}

}  // namespace dxslam
