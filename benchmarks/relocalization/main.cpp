// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// Relocalization, factor by factor: maps from one part of a recording, every query an isolated
// image of another. docs/relocalization.md describes rows and columns;
// benchmarks/relocalization/run runs it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "cached_extractor.h"
#include "features/extractor_factory.h"
#include "image_factors.h"
#include "io/primitives/image_file.h"
#include "io/recordings/sequence_reader.h"
#include "large_map.h"
#include "other_truth.h"
#include "start.h"
#include "synthetic_factors.h"
#include "trial.h"

namespace {

using namespace dxslam;
using namespace dxslam::benchmark;
namespace fs = std::filesystem;

struct Settings {
  std::string shared;
  std::string features = "hfnet";
  std::string csv;
  std::string cache;
  std::string start_map;
  std::string redkitchen_truth;
  std::vector<std::string> parts = {"redkitchen", "hololens", "time", "synthetic"};
  std::vector<std::string> scenes = {"room", "office"};
  double synthetic_fps = 5.0;
  std::string only;
  int every_photo = 1;
  int every_foreign = 3;  // of the recordings of other places every n-th frame is asked for
  RelocalizationOptions options;
};

// A recording split into map and queries.
struct Split {
  std::string name;
  std::string folder;
  std::string truth;  // file of the true poses; those of the recording if empty
  MapUnderTest::Picker in_map;
  MapUnderTest::Picker is_query;
  double right_distance = 0.05;
  std::vector<std::string> elsewhere;  // recordings of other places
};

int seven_scenes_number(const RgbdSequence& sequence, std::size_t i) {
  return static_cast<int>(std::lround(sequence.stamp(i) * 30.0));
}

Split redkitchen(const Settings& settings) {
  return {"redkitchen",
          "7scenes_redkitchen",
          settings.redkitchen_truth,
          [](std::size_t i, const RgbdSequence& s) { return seven_scenes_number(s, i) <= 598; },
          [](std::size_t i, const RgbdSequence& s) { return seven_scenes_number(s, i) >= 600; },
          0.05,
          {"hololens", "tum_fr1_rpy"}};
}

Split hololens() {
  return {"hololens",
          "hololens",
          "",
          [](std::size_t i, const RgbdSequence&) { return i % 5 != 4; },
          [](std::size_t i, const RgbdSequence&) { return i % 5 == 4; },
          0.10,
          {"7scenes_redkitchen", "tum_fr1_rpy"}};
}

std::unique_ptr<FeatureExtractor> make_features(const Settings& settings) {
  auto extractor = make_extractor(settings.features);
  if (settings.cache.empty()) return extractor;
  return std::make_unique<CachedExtractor>(std::move(extractor), settings.cache);
}

std::unique_ptr<RgbdSequence> open_recording(const Settings& settings, const Split& split) {
  auto sequence = open_sequence(settings.shared + "/data/" + split.folder);
  return split.truth.empty() ? std::move(sequence) : with_truth(std::move(sequence), split.truth);
}

// Whether a frame of the map was taken nearby, in nearly the same direction.
bool sees_map(const MapUnderTest& map, const SE3& truth) {
  constexpr double kDistance = 0.5;
  constexpr double kAngle = 30.0 * std::numbers::pi / 180.0;
  return std::any_of(map.true_map_poses().begin(), map.true_map_poses().end(),
                     [&](const StampedPose& pose) {
                       return translation_distance(pose.world_from_camera, truth) <= kDistance &&
                              rotation_angle(pose.world_from_camera, truth) <= kAngle;
                     });
}

std::vector<Query> queries_of(RgbdSequence& sequence, const Split& split, const MapUnderTest& map) {
  std::vector<Query> queries;
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    if (!split.is_query(i, sequence)) continue;
    const SE3& truth = sequence.ground_truth()[i].world_from_camera;
    if (!sees_map(map, truth)) continue;
    if (const std::optional<RgbdImage> image = sequence.read(i))
      queries.push_back({*image, truth, SE3()});
  }
  return queries;
}

void finish_row(const Row& row, const Settings& settings) {
  print_row(row);
  append_csv(settings.csv, row);
}

void ask_elsewhere(const Settings& settings, const Split& split, MapUnderTest& map,
                   const Relocalizer& relocalizer) {
  for (const std::string& folder : split.elsewhere) {
    const auto sequence = open_sequence(settings.shared + "/data/" + folder);
    Row row{split.name + ": images of " + folder, split.right_distance, 5.0, {}};
    for (std::size_t i = 0; i < sequence->size();
         i += static_cast<std::size_t>(settings.every_foreign)) {
      if (const std::optional<RgbdImage> image = sequence->read(i)) {
        row.outcomes.push_back(locate(map, relocalizer, {*image, std::nullopt, SE3()}));
      }
    }
    finish_row(row, settings);
  }
  std::vector<std::string> photos;
  for (const auto& entry : fs::recursive_directory_iterator(settings.shared + "/data/train")) {
    const std::string extension = entry.path().extension();
    if (extension == ".jpg" || extension == ".png") photos.push_back(entry.path());
  }
  std::sort(photos.begin(), photos.end());
  Row row{split.name + ": photos of other places", split.right_distance, 5.0, {}};
  for (std::size_t i = 0; i < photos.size(); i += static_cast<std::size_t>(settings.every_photo)) {
    RgbdImage image;
    image.color = read_color_image(photos[i]);
    row.outcomes.push_back(locate(map, relocalizer, {image, std::nullopt, SE3()}));
  }
  finish_row(row, settings);
}

// What the map itself is worth: its own frames, judged as the queries are.
void print_map(const Split& split, const MapUnderTest& map) {
  const auto right = [&](const MapAlignment& alignment) {
    const std::vector<Deviation> deviations = map.own_deviations(alignment);
    const auto n = std::count_if(deviations.begin(), deviations.end(), [&](const Deviation& d) {
      return d.within(split.right_distance, 5.0);
    });
    return 100.0 * static_cast<double>(n) / static_cast<double>(deviations.size());
  };
  fmt::print(
      "| {}: the map's own {} frames ({} keyframes, {} points) | | | {:.1f} % | {:.1f} % | "
      "| | | | | | |\n",
      split.name, map.true_map_poses().size(), map.map().keyframe_count(), map.map().point_count(),
      right(map.alignment()), right(map.alignment_with_offset()));
}

void measure_split(const Settings& settings, const Split& split) {
  const auto sequence = open_recording(settings, split);
  MapUnderTest map(*sequence, make_features(settings), split.in_map, split.right_distance);
  print_map(split, map);
  const Relocalizer relocalizer(map.camera(), map.extractor().traits(), settings.options);
  const std::vector<Query> queries = queries_of(*sequence, split, map);
  for (const ImageFactor& factor : image_factors()) {
    if (factor.name.find(settings.only) == std::string::npos) continue;
    Row row{split.name + ": " + factor.name, split.right_distance, 5.0, {}};
    for (const Query& query : queries) {
      row.outcomes.push_back(locate(map, relocalizer, factor.apply(query, map.camera())));
    }
    finish_row(row, settings);
  }
  ask_elsewhere(settings, split, map, relocalizer);
}

// A large map: the redkitchen map and enough altered copies of it for 1000 keyframes.
void measure_time(const Settings& settings) {
  const Split split = redkitchen(settings);
  const auto sequence = open_recording(settings, split);
  MapUnderTest map(*sequence, make_features(settings), split.in_map, split.right_distance);
  const Map large = enlarge_map(map.map(), 1000);
  const GlobalIndex index = index_keyframes(large);
  const Relocalizer relocalizer(map.camera(), map.extractor().traits(), settings.options);
  Row row{
      fmt::format("redkitchen in a map of {} keyframes", large.keyframe_count()), 0.05, 5.0, {}};
  for (const Query& query : queries_of(*sequence, split, map)) {
    row.outcomes.push_back(locate(map, large, index, relocalizer, query));
  }
  finish_row(row, settings);
}

// Program start with a large map: the hololens map and altered copies of it.
void measure_program_start(const Settings& settings) {
  constexpr int kRuns = 9;
  const Split split = hololens();
  const auto sequence = open_recording(settings, split);
  MapUnderTest map(*sequence, make_features(settings), split.in_map, split.right_distance);
  const std::optional<RgbdImage> image = sequence->read(4);
  const fs::path file = settings.start_map.empty()
                            ? fs::temp_directory_path() / "relocalization_benchmark.dxmap"
                            : fs::path(settings.start_map);
  measure_start(
      enlarge_map(map.map(), 1000), map.camera(), image.value(),
      [&] { return make_extractor(settings.features); }, file, kRuns);
  if (settings.start_map.empty()) fs::remove(file);
}

void measure_synthetic(const Settings& settings) {
  SyntheticTrial trial;
  trial.make_extractor = [&] { return make_features(settings); };
  trial.options = settings.options;
  trial.csv = settings.csv;
  trial.only = settings.only;
  trial.fps = settings.synthetic_fps;
  for (const std::string& scene : settings.scenes) {
    trial.scene = scene;
    measure_synthetic_factors(trial);
  }
}

int run(const Settings& settings) {
  if (settings.parts != std::vector<std::string>{"synthetic"} &&
      settings.parts != std::vector<std::string>{"start"})
    print_heading();
  for (const std::string& part : settings.parts) {
    if (part == "redkitchen") measure_split(settings, redkitchen(settings));
    if (part == "hololens") measure_split(settings, hololens());
    if (part == "time") measure_time(settings);
    if (part == "start") measure_program_start(settings);
    if (part == "synthetic") measure_synthetic(settings);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Relocalization, factor by factor");
  Settings settings;
  app.add_option("SHARED", settings.shared, "Folder with data/")->required();
  app.add_option("--features", settings.features, "Extractor name or model manifest")
      ->capture_default_str();
  app.add_option("--csv", settings.csv, "File that every single outcome is appended to");
  app.add_option("--cache", settings.cache,
                 "Folder that keeps features, so that a second run need not extract them");
  app.add_option("--parts", settings.parts, "redkitchen, hololens, time, start, synthetic")
      ->delimiter(',');
  app.add_option("--start-map", settings.start_map, "Keep the large map of the part start here");
  app.add_option("--redkitchen-truth", settings.redkitchen_truth,
                 "Trajectory in TUM format to judge redkitchen by, instead of the recording's own");
  app.add_option("--every-foreign", settings.every_foreign,
                 "Ask for every n-th frame of recordings of other places")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--only", settings.only, "Only factors with this in their name");
  app.add_option("--every-photo", settings.every_photo, "Ask for every n-th photo")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--scenes", settings.scenes, "Synthetic scenes: room, office, corridor")
      ->delimiter(',');
  app.add_option("--synthetic-fps", settings.synthetic_fps, "Frame rate in the synthetic scenes")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    return run(settings);
  } catch (const std::exception& e) {
    fmt::print(stderr, "relocalization_benchmark: {}\n", e.what());
    return 1;
  }
}
