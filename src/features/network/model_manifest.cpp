// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/network/model_manifest.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/error.h"
#include "features/data_directory.h"
#include "features/sha256.h"
#include "io/formats/options_yaml.h"
#include "io/primitives/input_file.h"
#include "io/primitives/lfs_pointer.h"
#include "io/primitives/text_file.h"
#include "io/primitives/yaml_map.h"

namespace dxslam {
namespace {

namespace fs = std::filesystem;

constexpr int kFormat = 1;
constexpr std::size_t kLongestName = 200;  // it stands in maps

[[noreturn]] void fail(const YamlMap& map, const std::string& what) {
  throw InputError(fmt::format("{}: {}", map.where(), what));
}

YamlMap required_map(YamlMap& map, const char* name) {
  auto nested = map.take_map(name);
  if (!nested) fail(map, fmt::format("`{}` is missing", name));
  return std::move(*nested);
}

std::string required_text(YamlMap& map, const char* name) {
  std::string value;
  if (!map.take(name, value) || value.empty()) fail(map, fmt::format("`{}` is missing", name));
  return value;
}

/// A text that must be one of two; the first is the default.
bool is_second(YamlMap& map, const char* name, const char* first, const char* second) {
  std::string value = first;
  map.take(name, value);
  if (value != first && value != second) {
    fail(map, fmt::format("`{}` is `{}`, expected {} or {}", name, value, first, second));
  }
  return value == second;
}

int integer(YamlMap& map, const char* name, int fallback, Range range, const char* unit) {
  long long value = fallback;
  map.take_integer(name, value, range, unit);
  return static_cast<int>(value);
}

template <class Options>
void read_options(YamlMap& map, Options& options) {
  OptionsYamlReader reader(map);
  Options::describe(options, reader);
}

TensorLayout read_layout(YamlMap& map) {
  return is_second(map, "layout", "nchw", "nhwc") ? TensorLayout::kNhwc : TensorLayout::kNchw;
}

std::string read_hash(YamlMap& map, const char* name) {
  std::string hash;
  map.take(name, hash);
  const bool digits = hash.find_first_not_of("0123456789abcdef") == std::string::npos;
  if (hash.empty() || (hash.size() == 64 && digits)) return hash;
  fail(map, fmt::format("`{}` is `{}`, expected 64 lower-case hexadecimal digits", name, hash));
}

ModelFile read_file(YamlMap map, const fs::path& folder) {
  ModelFile file;
  const fs::path path = expand_variables(required_text(map, "file"));
  file.path = (path.is_absolute() ? path : folder / path).lexically_normal().string();
  file.sha256 = read_hash(map, "sha256");
  file.weights_sha256 = read_hash(map, "weights_sha256");
  map.finish();
  return file;
}

ModelVariants read_variants(YamlMap map, const fs::path& folder) {
  ModelVariants variants;
  variants.floating = read_file(required_map(map, "float"), folder);
  if (auto int8 = map.take_map("int8")) variants.int8 = read_file(std::move(*int8), folder);
  map.finish();
  return variants;
}

std::vector<double> read_per_channel(YamlMap& map, const char* name, int channels) {
  std::vector<double> values;
  if (map.take(name, values) && values.size() != static_cast<std::size_t>(channels)) {
    fail(map, fmt::format("`{}` has {} numbers, expected {}, one per channel", name, values.size(),
                          channels));
  }
  return values;
}

void read_normalization(YamlMap& map, InputDescription& input) {
  map.take("scale", input.scale, {1e-9, 1e9}, "");
  input.mean = read_per_channel(map, "mean", input.channels);
  input.deviation = read_per_channel(map, "std", input.channels);
  for (const double deviation : input.deviation) {
    if (!(deviation > 0.0)) fail(map, fmt::format("`std` has {}, expected above 0", deviation));
  }
  input.instance_normalized = is_second(map, "normalization", "none", "instance");
  map.take("deviation_floor", input.deviation_floor, {0, 255}, "grey levels");
  input.unshuffle = integer(map, "unshuffle", 1, {1, 16}, "pixels");
  map.take("quantization_step", input.quantization_step, {1e-9, 1e9}, "");
  if (input.unshuffle > 1 && !(input.instance_normalized && input.channels == 1)) {
    fail(map, "`unshuffle` is given, expected one channel and `normalization: instance` with it");
  }
  if (input.quantization_step > 0.0 && input.unshuffle == 1) {
    fail(map, "`quantization_step` is given, expected `unshuffle` with it");
  }
}

void read_fixed_size(YamlMap& map, InputDescription& input) {
  std::vector<double> size;
  if (!map.take("fixed_size", size)) return;
  if (size.size() != 2 || !(size[0] >= 32.0) || !(size[1] >= 32.0) || !(size[0] <= 16384.0) ||
      !(size[1] <= 16384.0)) {
    fail(map, "`fixed_size` must be [width, height], each of 32 to 16384 pixels");
  }
  input.fixed_width = static_cast<int>(size[0]);
  input.fixed_height = static_cast<int>(size[1]);
}

InputDescription read_input(YamlMap map) {
  InputDescription input;
  input.name = required_text(map, "name");
  input.channels = integer(map, "channels", 0, {1, 3}, "channels");
  if (input.channels != 1 && input.channels != 3) {
    fail(map, fmt::format("`channels` is {}, expected 1 or 3", input.channels));
  }
  input.layout = read_layout(map);
  input.bgr = is_second(map, "color", "rgb", "bgr");
  read_normalization(map, input);
  input.size_multiple = integer(map, "size_multiple", 32, {1, 256}, "pixels");
  read_fixed_size(map, input);
  map.finish();
  return input;
}

std::optional<OutputDescription> read_output(YamlMap& outputs, const char* role) {
  auto map = outputs.take_map(role);
  if (!map) return std::nullopt;
  OutputDescription output;
  output.name = required_text(*map, "name");
  output.layout = read_layout(*map);
  map->finish();
  return output;
}

void read_outputs(YamlMap map, ModelManifest& manifest) {
  manifest.keypoint_logits = read_output(map, "keypoint_logits");
  manifest.scores = read_output(map, "scores");
  const auto descriptors = read_output(map, "descriptors");
  if (!descriptors) fail(map, "`descriptors` is missing");
  manifest.descriptors = *descriptors;
  manifest.reliability = read_output(map, "reliability");
  manifest.features = read_output(map, "features");
  manifest.global = read_output(map, "global");
  const int sources = (manifest.keypoint_logits ? 1 : 0) + (manifest.scores ? 1 : 0) +
                      (manifest.detection_from_descriptors ? 1 : 0);
  if (sources != 1) {
    fail(map, fmt::format("found {} sources of keypoints, expected exactly one of "
                          "outputs.keypoint_logits, outputs.scores and "
                          "detection_from_descriptors: true",
                          sources));
  }
  map.finish();
}

void read_global(YamlMap& top, ModelManifest& manifest, const fs::path& folder) {
  if (auto map = top.take_map("global_head")) {
    manifest.global_head =
        GlobalHeadDescription{read_variants(required_map(*map, "files"), folder),
                              required_text(*map, "input"), required_text(*map, "output")};
    map->finish();
    if (!manifest.features) fail(top, "`global_head` is given, but outputs.features is missing");
    if (manifest.global) fail(top, "found both global_head and outputs.global, expected one");
  }
  manifest.global_dimension = integer(top, "global_dimension", 0, {0, 65536}, "floats");
  const bool has_global = manifest.global || manifest.global_head;
  if (has_global != (manifest.global_dimension > 0)) {
    fail(top, fmt::format("`global_dimension` is {}, expected {}", manifest.global_dimension,
                          has_global ? "the length of the global descriptor"
                                     : "none without outputs.global or global_head"));
  }
}

void read_detection(YamlMap& top, ModelManifest& manifest) {
  YamlMap detector = required_map(top, "detector");
  manifest.cell_size = integer(detector, "cell_size", 8, {2, 32}, "pixels");
  read_options(detector, manifest.detector);
  detector.finish();
  YamlMap descriptor = required_map(top, "descriptor");
  read_options(descriptor, manifest.descriptor);
  if (manifest.descriptor.dimension == 0) fail(descriptor, "`dimension` is missing");
  descriptor.finish();
}

void check_size_multiple(const YamlMap& top, const ModelManifest& manifest) {
  const int multiple = manifest.input.size_multiple;
  if (multiple % manifest.input.unshuffle != 0) {
    fail(top, fmt::format("input.size_multiple is {}, expected a multiple of input.unshuffle {}",
                          multiple, manifest.input.unshuffle));
  }
  if (manifest.keypoint_logits && multiple % manifest.cell_size != 0) {
    fail(top, fmt::format("input.size_multiple is {}, expected a multiple of detector.cell_size {}",
                          multiple, manifest.cell_size));
  }
  if (multiple % manifest.descriptor.stride != 0) {
    fail(top, fmt::format("input.size_multiple is {}, expected a multiple of descriptor.stride {}",
                          multiple, manifest.descriptor.stride));
  }
}

// Throws also for what is no file at all, such as a pipe.
void refuse_pointer(const std::string& path) {
  const InputFile file(path, "a model");
  std::string start(64, '\0');
  start.resize(file.read(start.data(), start.size()));
  const std::string_view hint = lfs_hint(start);
  if (!hint.empty()) throw InputError(fmt::format("{}: no model{}", path, hint));
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
  YamlMap top = YamlMap::parse(read_file(path, "a model manifest", limits::kYamlBytes), path);
  const int format = integer(top, "format", 0, {0, 1000000}, "");
  if (format != kFormat) {
    fail(top, fmt::format("`format` is {}, expected {}", format, kFormat));
  }
  const fs::path folder = fs::path(path).parent_path();
  ModelManifest manifest;
  manifest.path = path;
  manifest.name = required_text(top, "name");
  if (manifest.name.size() > kLongestName ||
      std::any_of(manifest.name.begin(), manifest.name.end(),
                  [](unsigned char c) { return c < 0x20 || c == 0x7F; })) {
    fail(top, fmt::format("`name` has {} bytes, expected at most {}, without control characters",
                          manifest.name.size(), kLongestName));
  }
  manifest.description = required_text(top, "description");
  manifest.licence = required_text(top, "licence");
  manifest.files = read_variants(required_map(top, "files"), folder);
  manifest.input = read_input(required_map(top, "input"));
  top.take("detection_from_descriptors", manifest.detection_from_descriptors);
  read_outputs(required_map(top, "outputs"), manifest);
  read_global(top, manifest, folder);
  read_detection(top, manifest);
  check_size_multiple(top, manifest);
  top.take_map("info");  // not read
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
  if (!fs::is_directory(path)) {
    refuse_pointer(file.path);
    verify_hash(file.path, file.sha256);
  }
  if (path.extension() != ".xml") return;
  const std::string weights = fs::path(path).replace_extension(".bin").string();
  if (!fs::exists(weights)) {
    throw InputError(
        fmt::format("{}: no such file, expected the weights of {}", weights, file.path));
  }
  refuse_pointer(weights);
  verify_hash(weights, file.weights_sha256);
}

}  // namespace dxslam
