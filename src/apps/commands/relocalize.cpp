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
#include "apps/open_recording.h"
#include "apps/output_steps.h"
#include "apps/process.h"
#include "apps/progress.h"
#include "apps/recording_report.h"
#include "apps/stoppable_sequence.h"
#include "apps/usage.h"
#include "core/error.h"
#include "evaluation/statistics.h"
#include "io/formats/options_yaml.h"
#include "io/formats/trajectory_file.h"
#include "io/primitives/atomic_file.h"
#include "io/primitives/result_folder.h"
#include "io/recordings/sequence_reader.h"
#include "relocalization/relocalizer.h"
#include "slam/stage_times.h"
#include "slam/stored_system.h"
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
  std::vector<SkippedFrame> failed;
  int most_inliers = 0;  // of one frame

  void add(double stamp, const RelocalizationReport& report, double ms) {
    if (report.accepted) poses.push_back({stamp, report.world_from_camera});
    times.push_back(ms);
    most_inliers = std::max(most_inliers, report.inliers);
    rows += fmt::format("{:.6f},{:d},{},{},{:.3f},{:.4f},{},{},{:.4f},{},{},{:.3f}\n", stamp,
                        report.accepted, report.inliers, report.groups_tried, ms, report.confidence,
                        report.matched, report.visible, report.spread, report.component,
                        report.has_pose ? static_cast<std::int64_t>(report.reference) : -1,
                        report.coverage);
  }
};

ResultFiles relocalization_files() {
  return {{{"poses.txt", trajectory_kind()},
           {"relocalization.csv",
            kind_by_beginning("a table of `dxslam relocalize`", {"stamp,accepted,"})}},
          {"relocalization.csv"},
          {"relocalization.csv"}};
}

// A recording may have its true poses in a file of the same name.
void require_own_poses(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  const std::string poses = (folder / "poses.txt").string();
  if (!fs::exists(poses) || fs::exists(folder / "relocalization.csv")) return;
  throw InputError(fmt::format(
      "{}: is not from `dxslam relocalize` and would be replaced, expected another --out", poses));
}

void write_results(OutputSteps& steps, ResultFolder& folder, const Results& results) {
  if (!steps.run([&] { folder.begin(); })) return;
  steps.run([&] { write_trajectory(folder.file("poses.txt"), results.poses); });
  steps.run([&] { write_file_atomically(folder.file("relocalization.csv"), results.rows); });
}

Results ask_all(const RelocalizeArguments& arguments, RgbdSequence& sequence,
                FeatureExtractor& extractor, const SearchedMap& map,
                const Relocalizer& relocalizer) {
  const std::optional<LowLight> low_light =
      arguments.low_light > 0.0 ? std::optional<LowLight>(arguments.low_light) : std::nullopt;
  Progress progress("frames", (sequence.size() + arguments.stride - 1) / arguments.stride);
  Results results;
  ImageAttempts attempts;
  std::size_t done = 0;
  for (std::size_t i = 0; i < sequence.size(); i += arguments.stride) {
    const auto failure = attempts.attempt(i, [&] {
      std::optional<RgbdImage> image = sequence.read(i);
      if (!image || stop_requested()) return;
      if (low_light) image->color = low_light->apply(image->color, image->index);
      const FramePtr frame =
          make_frame(*image, extractor.extract(image->color, true), sequence.camera());
      const Stopwatch watch;
      const RelocalizationReport report = relocalizer.relocalize(map.stored.map, map.index, *frame);
      results.add(image->stamp, report, watch.ms());
      progress.update(done + 1, report.accepted ? "found" : "not found");
    });
    if (failure) results.failed.push_back(*failure);
    if (stop_requested()) break;
    ++done;
  }
  progress.finish();
  return results;
}

// The exit code, and why too few frames were found.
int judge(const Results& results, const std::string& map) {
  if (results.times.empty()) {
    warn("no frame was found: no image could be read");
    return kTrackingFailed;
  }
  const std::size_t found = results.poses.size();
  const std::size_t frames = results.times.size();
  if (static_cast<double>(found) >= kLeastTrackedShare * static_cast<double>(frames)) {
    return kSuccess;
  }
  if (found > 0) {
    warn("only {} of {} frames were found", found, frames);
    return kTrackingFailed;
  }
  warn("no frame was found: at most {} keypoints of one agree with a pose in {}, of {} images",
       results.most_inliers, map, frames);
  return kTrackingFailed;
}

int relocalize(const RelocalizeArguments& arguments) {
  SystemOptions options;
  if (!arguments.config.empty()) options = load_options(arguments.config, options);
  const std::unique_ptr<RgbdSequence> sequence =
      stoppable(open_recording(arguments.sequence, arguments.reader));
  std::optional<ResultFolder> folder;
  if (!arguments.out.empty()) {
    require_own_poses(arguments.out);
    folder.emplace(arguments.out, relocalization_files());
  }
  const std::unique_ptr<FeatureExtractor> extractor = make_extractor(arguments.features);
  const SearchedMap map = open_map(arguments, map_header(*extractor));
  if (const auto other = says_other_camera(map.stored.map.rig(), sequence->camera())) {
    warn("{}: {}", arguments.map, *other);
  }
  const Relocalizer relocalizer(sequence->camera(), extractor->traits(), options.relocalization);
  print_recording(*sequence);
  std::optional<Unsaved> unsaved(std::in_place);
  const Results results = ask_all(arguments, *sequence, *extractor, map, relocalizer);
  OutputSteps steps;
  if (folder) write_results(steps, *folder, results);
  unsaved.reset();
  print("{} of {} found in a map of {}; {:.1f} ms per frame (median)\n", results.poses.size(),
        counted(results.times.size(), "frame"),
        counted(map.stored.map.keyframe_count(), "keyframe"), summarise(results.times).median);
  print_skipped(all_skipped(*sequence, results.failed));
  if (folder) steps.tell_place(folder->path());
  const bool stopped = stop_requested();
  return steps.end_results(folder ? &*folder : nullptr,
                           stopped ? kInterrupted : judge(results, arguments.map));
}

}  // namespace

void add_relocalize_command(CLI::App& app) {
  const auto arguments = std::make_shared<RelocalizeArguments>();
  CLI::App* command =
      app.add_subcommand("relocalize", "find every frame of a recording in a map, each by itself");
  command->add_option("MAP", arguments->map, "map file")->required();
  command->add_option("SEQUENCE", arguments->sequence, recording_help())->required();
  command->add_option("--out", arguments->out,
                      "folder for poses.txt (accepted ones, in the map's frame) and "
                      "relocalization.csv");
  add_reader_options(*command, arguments->reader);
  command->add_option("--config", arguments->config, "YAML file; see `dxslam config dump`");
  command->add_option("--stride", arguments->stride, "use every n-th frame")
      ->check(whole_number(1));
  add_feature_options(*command, arguments->features);
  add_low_light_option(*command, arguments->low_light);
  command->callback([arguments] {
    if (const int code = relocalize(*arguments); code != kSuccess) throw CLI::RuntimeError(code);
  });
}

}  // namespace dxslam::apps
