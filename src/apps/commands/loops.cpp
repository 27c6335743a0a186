// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>

#include "apps/commands.h"
#include "apps/console.h"
#include "apps/loop_experiment.h"
#include "apps/loops_output.h"
#include "apps/open_recording.h"
#include "apps/process.h"
#include "apps/progress.h"
#include "apps/recording_report.h"
#include "apps/stoppable_sequence.h"
#include "apps/usage.h"
#include "core/error.h"
#include "core/options.h"
#include "evaluation/statistics.h"
#include "io/formats/options_yaml.h"
#include "synthetic/low_light.h"

namespace dxslam::apps {
namespace {

struct LoopsArguments {
  LoopSettings settings;
  std::string config;
};

std::string share(double value) {
  return std::isfinite(value) ? fmt::format("{:.4f}", value) : "-";
}

void print_table(const LoopExperiment& experiment, const std::vector<NamedCurve>& curves) {
  print("{} queries, {} of them with a true loop; {} places{}\n", experiment.queries.size(),
        curves.front().curve.queries_with_loop, experiment.places.size(),
        experiment.interrupted ? ", since it was stopped" : "");
  if (curves.front().curve.queries_with_loop == 0) {
    warn("no query has a true loop, so that there is no recall");
  }
  print("{:<28} {:>18} {:>18} {:>16}\n", "method", "recall at 100 %", "average precision",
        "median query ms");
  for (std::size_t i = 0; i < curves.size(); ++i) {
    std::vector<double> times;
    for (const LoopQuery& query : experiment.runs[i].queries) times.push_back(query.ms);
    print("{:<28} {:>18} {:>18} {:>16.2f}\n", curves[i].name,
          share(curves[i].curve.recall_at_100_precision), share(curves[i].curve.average_precision),
          summarise(times).median);
  }
}

int find_loops(const LoopsArguments& arguments) {
  LoopSettings settings = arguments.settings;
  if (!arguments.config.empty()) {
    settings.detector = load_options(arguments.config, settings.detector);
  }
  validate_options("truth", settings.poses);
  for (const std::string& name : settings.methods) parse_loop_method(name);
  SequenceOptions reader = settings.reader;
  reader.needs_calibration = false;
  const std::unique_ptr<RgbdSequence> sequence =
      stoppable(open_recording(settings.sequence, reader));
  if (settings.truth == "poses" && sequence->ground_truth().empty()) {
    throw InputError(fmt::format(
        "{}: the recording has no poses{}, expected --ground-truth with a file", settings.sequence,
        sequence->facts().truth_problem.empty() ? "" : " that can be read"));
  }
  if (settings.low_light_from && *settings.low_light_from >= sequence->size()) {
    throw InputError(fmt::format("--low-light-from {}: expected a frame of the {} of {}",
                                 *settings.low_light_from, sequence->size(), settings.sequence));
  }
  std::optional<LoopTruth> truth;  // a file is read at once, so that mistakes show at once
  if (settings.truth != "poses") truth = load_loop_truth(settings, *sequence, {});
  std::optional<ResultFolder> folder;  // before anything costs time
  if (!settings.out.empty()) folder.emplace(settings.out, loop_result_files());
  std::optional<Unsaved> unsaved;
  Progress progress("images", sequence->size());
  const LoopExperiment experiment =
      run_loop_experiment(settings, *sequence, [&](std::size_t done, std::size_t) {
        if (!unsaved) unsaved.emplace();  // networks and vocabularies are loaded
        progress.update(done, "finding loops");
      });
  progress.finish();
  // To judge very many images takes longer than anybody waits after a stop.
  unsaved.reset();
  if (experiment.queries.empty() && stop_requested()) return kInterrupted;
  if (experiment.queries.empty()) {
    throw InputError(fmt::format("{}: no image to ask for, expected some{}", settings.sequence,
                                 settings.second_pass_from ? " in the second pass" : ""));
  }
  if (!truth) truth = load_loop_truth(settings, *sequence, experiment.views);
  const std::vector<NamedCurve> curves = judge_methods(experiment, *truth);
  OutputSteps steps;
  if (folder) {
    write_loop_results(steps, *folder, settings, experiment, *truth, curves, sequence->name());
  }
  print_table(experiment, curves);
  print_skipped(all_skipped(*sequence, experiment.failed));
  if (folder) steps.tell_place(folder->path());
  const int code = experiment.interrupted ? kInterrupted : kSuccess;
  return steps.end_results(folder ? &*folder : nullptr, code);
}

void refuse_unused_options(const CLI::App& command, const LoopSettings& settings) {
  bool words = false;
  bool learned = false;
  bool orb = false;
  for (const std::string& name : settings.methods) {
    const LoopMethod method = parse_loop_method(name);
    orb = orb || method.orb;
    learned = learned || !method.orb;
    words = words || (!method.orb && method.words);
  }
  const auto check = [&](const char* option, bool used, const char* meant) {
    refuse_unused(command, option, used, meant);
  };
  for (const char* option : {"--radius", "--angle", "--unclear", "--overlap"}) {
    check(option, settings.truth == "poses", "with --ground-truth poses");
  }
  check("--low-light-gain", settings.low_light_from.has_value(), "with --low-light-from");
  check("--features", learned, "with a method other than orb-bow");
  check("--vocabulary", words, "with a method other than orb-bow that has words");
  check("--orb-vocabulary", orb, "with method orb-bow");
}

void add_input_options(CLI::App& command, LoopSettings& settings) {
  command.add_option("SEQUENCE", settings.sequence, recording_help())->required();
  command
      .add_option("--ground-truth", settings.truth,
                  "`poses`, or a square matrix as .mat (v5), text or black-and-white image")
      ->required();
  add_reader_options(command, settings.reader);
  command
      .add_option("--eye", settings.reader.eye,
                  "all, left or right: images of which camera, where two take turns")
      ->check(one_of({"all", "left", "right"}))
      ->capture_default_str();
  command.add_option("--stride", settings.stride, "use every n-th frame")->check(whole_number(1));
  command.add_option("--max-frames", settings.max_frames, "stop after so many frames, 0 = use all")
      ->check(whole_number(0));
  PoseLoopOptions& poses = settings.poses;
  command.add_option("--window", poses.window, "seconds that a view must be old to be found")
      ->check(range_of<PoseLoopOptions>("window"))
      ->capture_default_str();
  command.add_option("--radius", poses.radius, "true loops from poses: metres apart at most")
      ->check(range_of<PoseLoopOptions>("radius"))
      ->capture_default_str();
  command.add_option("--angle", poses.angle, "true loops from poses: degrees apart at most")
      ->check(range_of<PoseLoopOptions>("angle"))
      ->capture_default_str();
  command
      .add_option("--unclear", poses.unclear,
                  "pairs within so many times radius and angle are neither right nor wrong")
      ->check(range_of<PoseLoopOptions>("unclear"))
      ->capture_default_str();
  command
      .add_option("--overlap", poses.overlap,
                  "pairs that share this much of what they see are not wrong (with depth)")
      ->check(range_of<PoseLoopOptions>("overlap"))
      ->capture_default_str();
  command
      .add_option("--second-pass-from", settings.second_pass_from,
                  "frames before it are places only, frames from it on queries only")
      ->check(whole_number(0));
  command
      .add_option("--low-light-from", settings.low_light_from,
                  "darken the images from this frame on (low-light model)")
      ->check(whole_number(0));
  command
      .add_option("--low-light-gain", settings.low_light_gain,
                  fmt::format("how much (default {})", LowLight::kDefaultGain))
      ->check(low_light_gain());
}

void add_method_options(CLI::App& command, LoopsArguments& arguments) {
  LoopSettings& settings = arguments.settings;
  command
      .add_option(
          "--method", settings.methods,
          fmt::format("one or more, separated by commas: {}", fmt::join(loop_method_names(), ", ")))
      ->delimiter(',')
      ->check(accepted_by([](const std::string& name) { parse_loop_method(name); }))
      ->required();
  command.add_option("--config", arguments.config,
                     "YAML file of thresholds and other options of the detector");
  command
      .add_option("--candidates", settings.detector.candidates,
                  "similar places by words whose global descriptors are compared")
      ->check(range_of<LoopOptions>("candidates"))
      ->capture_default_str();
  command
      .add_option("--features", settings.features,
                  "extractor of all methods but orb-bow: name or model manifest")
      ->check(extractor_name());
  command.add_option("--vocabulary", settings.hf_vocabulary,
                     "its vocabulary (default: models/vocabulary/NAME.fbow)");
  command.add_option("--orb-vocabulary", settings.orb_vocabulary,
                     "vocabulary of orb-bow (default: models/vocabulary/orb.fbow)");
  command
      .add_option("--max-keypoints", settings.extractor.max_keypoints,
                  "most keypoints per image, of either extractor; 0 = as it says")
      ->check(range_of<ExtractorOptions>("max_keypoints"))
      ->capture_default_str();
  command.add_option("--threads", settings.extractor.threads, "threads of the network")
      ->check(range_of<ExtractorOptions>("threads"))
      ->capture_default_str();
  command.add_flag("--deterministic", settings.extractor.deterministic,
                   "exact arithmetic: the same result every time");
  command.add_option("--out", settings.out,
                     "folder for candidates.csv, pr.csv, pr.svg and summary.json");
}

}  // namespace

void add_loops_command(CLI::App& app) {
  const auto arguments = std::make_shared<LoopsArguments>();
  CLI::App* command =
      app.add_subcommand("loops", "find loops in a recording and judge them by the truth");
  add_input_options(*command, arguments->settings);
  add_method_options(*command, *arguments);
  command->callback([arguments, command] {
    refuse_unused_options(*command, arguments->settings);
    if (const int code = find_loops(*arguments); code != kSuccess) throw CLI::RuntimeError(code);
  });
}

}  // namespace dxslam::apps
