// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "apps/commands.h"
#include "apps/console.h"
#include "apps/features_arguments.h"
#include "apps/map_io.h"
#include "apps/progress.h"
#include "apps/usage.h"
#include "core/error.h"
#include "evaluation/statistics.h"
#include "io/formats/options_yaml.h"
#include "io/formats/trajectory_file.h"
#include "io/primitives/atomic_file.h"
#include "io/recordings/sequence_reader.h"
#include "relocalization/relocalizer.h"
#include "slam/stage_times.h"
#include "slam/system_options.h"
#include "synthetic/low_light.h"

namespace dxslam::apps {
namespace {

struct RelocalizeArguments {
  std::string map;
  std::string sequence;
  std::string out;
  std::string config;
  SequenceOptions reader;
  FeatureArguments features;
  std::size_t stride = 1;
  double low_light = 0.0;
};

// A stored map, ready to be asked.
struct SearchedMap {
  StoredMap stored;
  GlobalIndex index;
};

SearchedMap open_map(const RelocalizeArguments& arguments, const MapHeader& current) {
  SearchedMap searched{load_map(arguments.map), {}};
  require_same_features(searched.stored.header, current, arguments.map);
  searched.index = index_keyframes(searched.stored.map);
  if (searched.index.size() == 0) {
    throw InputError(fmt::format(
        "{}: no keyframe has a global descriptor, expected a map made with features that have one",
        arguments.map));
  }
  return searched;
}

// What is written while the frames are asked, one after the other.
struct Results {
  Trajectory poses;
  std::string rows =
      "stamp,accepted,inliers,groups_tried,ms,confidence,matched,visible,spread,component,"
      "keyframe,coverage\n";
  std::vector<double> times;

  void add(double stamp, const RelocalizationReport& report, double ms) {
    if (report.accepted) poses.push_back({stamp, report.world_from_camera});
    times.push_back(ms);
    rows += fmt::format("{:.6f},{:d},{},{},{:.3f},{:.4f},{},{},{:.4f},{},{},{:.3f}\n", stamp,
                        report.accepted, report.inliers, report.groups_tried, ms, report.confidence,
                        report.matched, report.visible, report.spread, report.component,
                        report.has_pose ? static_cast<std::int64_t>(report.reference) : -1,
                        report.coverage);
  }
};

void write_results(const std::string& folder, const Results& results) {
  make_folder(folder);
  const std::filesystem::path out(folder);
  write_trajectory(out / "poses.txt", results.poses);
  write_file_atomically(out / "relocalization.csv", results.rows);
}

Results ask_all(const RelocalizeArguments& arguments, RgbdSequence& sequence,
                FeatureExtractor& extractor, const SearchedMap& map,
                const Relocalizer& relocalizer) {
  const std::optional<LowLight> low_light =
      arguments.low_light > 0.0 ? std::optional<LowLight>(arguments.low_light) : std::nullopt;
  Progress progress("frames", (sequence.size() + arguments.stride - 1) / arguments.stride);
  Results results;
  std::size_t done = 0;
  for (std::size_t i = 0; i < sequence.size(); i += arguments.stride) {
    std::optional<RgbdImage> image = sequence.read(i);
    ++done;
    if (!image) continue;
    if (low_light) image->color = low_light->apply(image->color, image->index);
    const FramePtr frame =
        make_frame(*image, extractor.extract(image->color, true), sequence.camera());
    const Stopwatch watch;
    const RelocalizationReport report = relocalizer.relocalize(map.stored.map, map.index, *frame);
    results.add(image->stamp, report, watch.ms());
    progress.update(done, report.accepted ? "found" : "not found");
  }
  progress.finish();
  return results;
}

void relocalize(const RelocalizeArguments& arguments) {
  SystemOptions options;
  if (!arguments.config.empty()) options = load_options(arguments.config, options);
  const std::unique_ptr<RgbdSequence> sequence =
      open_sequence(arguments.sequence, arguments.reader);
  const std::unique_ptr<FeatureExtractor> extractor = make_extractor(arguments.features);
  const SearchedMap map = open_map(arguments, map_header(sequence->camera(), *extractor));
  const Relocalizer relocalizer(sequence->camera(), extractor->traits(), options.relocalization);
  const Results results = ask_all(arguments, *sequence, *extractor, map, relocalizer);
  if (!arguments.out.empty()) write_results(arguments.out, results);
  print("{} of {} frames found in a map of {} keyframes; {:.1f} ms per frame (median)\n",
        results.poses.size(), results.times.size(), map.stored.map.keyframe_count(),
        summarise(results.times).median);
  if (!arguments.out.empty()) print("results in {}\n", arguments.out);
}

}  // namespace

void add_relocalize_command(CLI::App& app) {
  const auto arguments = std::make_shared<RelocalizeArguments>();
  CLI::App* command =
      app.add_subcommand("relocalize", "find every frame of a recording in a map, each by itself");
  command->add_option("MAP", arguments->map, "map file")->required();
  command->add_option("SEQUENCE", arguments->sequence, "folder of the recording")->required();
  command->add_option("--out", arguments->out,
                      "folder for poses.txt (accepted ones, in the map's frame) and "
                      "relocalization.csv");
  command->add_option("--format", arguments->reader.format, "format of the recording")
      ->capture_default_str();
  command->add_option("--calibration", arguments->reader.calibration,
                      "camera preset or YAML file (default: by format)");
  command->add_option("--config", arguments->config, "YAML file; see `dxslam config dump`");
  command->add_option("--stride", arguments->stride, "use every n-th frame")
      ->check(whole_number(1));
  add_feature_options(*command, arguments->features);
  add_low_light_option(*command, arguments->low_light);
  command->callback([arguments] { relocalize(*arguments); });
}

}  // namespace dxslam::apps
