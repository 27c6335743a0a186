// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <set>
#include <vector>

#include "apps/command_files.h"
#include "apps/commands.h"
#include "apps/console.h"
#include "apps/features_arguments.h"
#include "apps/output_steps.h"
#include "apps/process.h"
#include "apps/system_setup.h"
#include "apps/usage.h"
#include "core/error.h"
#include "features/extractor_factory.h"
#include "io/formats/npz_writer.h"
#include "io/primitives/atomic_file.h"
#include "io/primitives/image_file.h"

namespace dxslam::apps {
namespace {

namespace fs = std::filesystem;

struct ExtractArguments {
  FeatureArguments extractor;
  std::vector<std::string> images;
  std::string npz;
  double low_light = 0.0;
};

std::string archive_name(const std::string& image) {
  return fs::path(image).stem().string() + ".npz";
}

void check_distinct(const std::vector<std::string>& images) {
  std::set<std::string> names;
  for (const std::string& image : images) {
    if (names.insert(archive_name(image)).second) continue;
    throw InputError(fmt::format("{}: two images would be written to {}, expected distinct names",
                                 image, archive_name(image)));
  }
}

void write_features(const Features& features, const std::string& path) {
  std::vector<float> positions;
  std::vector<float> scores;
  for (const Keypoint& keypoint : features.keypoints) {
    positions.push_back(keypoint.x);
    positions.push_back(keypoint.y);
    scores.push_back(keypoint.score);
  }
  NpzWriter writer;
  writer.add("keypoints", {features.size(), 2}, positions);
  writer.add("scores", {features.size()}, scores);
  writer.add("descriptors", features.descriptors);
  writer.add("global", {features.global.size()}, features.global);
  writer.write(path);
}

// Where the features of an image go to; empty for nowhere.
std::string archive(const ExtractArguments& arguments, const std::string& image) {
  if (arguments.npz.empty()) return {};
  return (fs::path(arguments.npz) / archive_name(image)).string();
}

void extract_one(const ExtractArguments& arguments, const std::string& path,
                 FeatureExtractor& extractor) {
  const cv::Mat image = read_image(path, arguments.low_light);
  const Features features = extractor.extract(image, true);
  double total = 0.0;
  for (const StageTime& stage : extractor.last_stages()) total += stage.ms;
  print("{}: {} keypoints, descriptors of {} {}, global descriptor of {}, {:.1f} ms\n", path,
        features.size(), features.descriptors.cols, extractor.traits().binary ? "bytes" : "floats",
        features.global.size(), total);
  if (!arguments.npz.empty()) write_features(features, archive(arguments, path));
}

// One that cannot be read or written costs no other.
void extract(const ExtractArguments& arguments) {
  check_distinct(arguments.images);
  if (!arguments.npz.empty()) make_folder(arguments.npz);
  CommandFiles files(arguments.images);
  for (const std::string& image : arguments.images) {
    files.writes("--npz", archive(arguments, image),
                 NpzWriter::kind("an archive of `dxslam features`", "keypoints"));
  }
  const auto extractor = make_extractor(arguments.extractor);
  OutputSteps steps;
  for (const std::string& image : arguments.images) {
    if (stop_requested()) break;
    steps.run([&] { extract_one(arguments, image, *extractor); });
  }
  steps.end_command();
}

}  // namespace

void add_feature_options(CLI::App& command, FeatureArguments& arguments) {
  command
      .add_option("--features", arguments.features,
                  "name of an extractor, or a model manifest (default: hfnet, or orb without it)")
      ->check(extractor_name());
  command
      .add_option("--max-keypoints", arguments.options.max_keypoints, "most keypoints per image")
      ->check(range_of<ExtractorOptions>("max_keypoints"));
  command
      .add_option("--spread", arguments.options.spread,
                  "share of the keypoints given out evenly over the image (0 to 1)")
      ->check(number(0.0, 1.0));
  command.add_option("--threads", arguments.options.threads, "threads of the network")
      ->check(range_of<ExtractorOptions>("threads"))
      ->capture_default_str();
  command.add_option("--precision", arguments.options.precision, "auto, f32, bf16 or int8")
      ->check(precision_name())
      ->capture_default_str();
  command.add_flag("--deterministic", arguments.options.deterministic,
                   "f32 arithmetic: the same bits in every run");
}

void add_low_light_option(CLI::App& command, double& gain) {
  command.add_option("--low-light", gain, "darken the images first (low-light model)")
      ->expected(0, 1)
      ->check(low_light_gain())
      ->default_str(fmt::format("{}", LowLight::kDefaultGain))
      ->type_name("[=GAIN]");
}

std::unique_ptr<FeatureExtractor> make_extractor(const FeatureArguments& arguments) {
  const bool chosen = !arguments.features.empty();
  const ExtractorChoice choice =
      chosen ? ExtractorChoice{arguments.features, ""} : choose_extractor();
  auto extractor = dxslam::make_extractor(choice.name, arguments.options);
  if (!choice.note.empty()) tell_notes({choice.note});
  tell_notes(extractor->notes());
  return extractor;
}

cv::Mat read_image(const std::string& path, double gain) {
  const cv::Mat image = read_color_image(path);
  return gain > 0.0 ? LowLight(gain).apply(image, 0) : image;
}

void add_extract_command(CLI::App& app) {
  auto arguments = std::make_shared<ExtractArguments>();
  CLI::App* command = app.add_subcommand("features", "extract features of images");
  command->add_option("images", arguments->images, "image files: PNG, JPEG, BMP, PGM, PPM or TIFF")
      ->required();
  command->add_option("--npz", arguments->npz,
                      "folder for one NumPy archive per image: keypoints N x 2 (pixels), scores N, "
                      "descriptors N x D, global G");
  add_feature_options(*command, arguments->extractor);
  add_low_light_option(*command, arguments->low_light);
  command->callback([arguments] { extract(*arguments); });
}

void add_features_command(CLI::App& app) {
  add_extract_command(app);
  add_match_command(app);
  add_bench_command(app);
}

}  // namespace dxslam::apps
