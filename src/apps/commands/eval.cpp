// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/command_files.h"
#include "apps/commands.h"
#include "apps/commands/eval_openloris.h"
#include "apps/console.h"
#include "apps/output_steps.h"
#include "apps/recording_report.h"
#include "apps/statistics_json.h"
#include "apps/trajectory_pair.h"
#include "apps/usage.h"
#include "core/error.h"
#include "evaluation/ate.h"
#include "evaluation/rpe.h"
#include "evaluation/svg.h"
#include "evaluation/time_offset.h"
#include "evaluation/trajectory_svg.h"
#include "io/formats/trajectory_reader.h"
#include "io/primitives/atomic_file.h"
#include "io/primitives/json_text.h"

namespace dxslam::apps {
namespace {

constexpr double kMaxDifference = 0.01;  // seconds

struct EvalArguments {
  TrajectoryFiles files;
  std::string json;
  std::string plot;
  std::string alignment = "se3";
  std::optional<double> max_difference;
  std::optional<double> search_offset;
  double delta = 1.0;
  std::string unit = "frames";
  bool consecutive = false;
};

Alignment alignment_of(const std::string& name) {
  if (name == "sim3") return Alignment::kSim3;
  return name == "se3" ? Alignment::kSe3 : Alignment::kNone;
}

void print_header() {
  print("{:<14} {:>10} {:>10} {:>10} {:>10} {:>10} {:>10} {:>7}\n", "", "rmse", "mean", "median",
        "std", "min", "max", "count");
}

void print_row(const std::string& label, const ErrorStatistics& s) {
  print("{:<14} {:>10.6f} {:>10.6f} {:>10.6f} {:>10.6f} {:>10.6f} {:>10.6f} {:>7}\n", label, s.rmse,
        s.mean, s.median, s.std, s.min, s.max, s.count);
}

// Before anything is read.
void require_targets(const EvalArguments& arguments) {
  CommandFiles files({arguments.files.truth, arguments.files.estimate});
  files.writes("--json", arguments.json, report_kind());
  files.writes("--plot", arguments.plot, svg_kind());
}

void write_json(OutputSteps& steps, const std::string& path, const nlohmann::ordered_json& report) {
  if (path.empty()) return;
  steps.run([&] { write_file_atomically(path, to_json_text(report)); });
}

TrajectoryPair load_pair(const EvalArguments& arguments) {
  TrajectoryPair pair = load_trajectory_pair(arguments.files);
  for (const std::string& note : pair.notes) warn("{}", note);
  if (pair.by_index && arguments.max_difference) {
    throw InputError(
        "option --max-difference is for stamps, expected none for poses without them (KITTI)");
  }
  if (pair.by_index && arguments.search_offset) {
    throw InputError(
        "option --search-offset is for stamps, expected none for poses without them (KITTI)");
  }
  return pair;
}

double max_difference(const EvalArguments& arguments) {
  return arguments.max_difference.value_or(kMaxDifference);
}

// Moves the estimate in time to where it fits best; returns by how much, if asked for.
std::optional<double> correct_clock(const EvalArguments& arguments, TrajectoryPair& pair) {
  if (!arguments.search_offset) return std::nullopt;
  TimeOffsetOptions options;
  options.range = *arguments.search_offset;
  options.alignment = alignment_of(arguments.alignment);
  const TimeOffset found = search_time_offset(pair.truth, pair.estimate, options);
  pair.estimate = shifted(pair.estimate, found.offset);
  print("time offset {:+.4f} s, added to the stamps of the estimate{}\n", found.offset,
        found.at_edge ? ": the end of what was searched, a longer search may fit better" : "");
  return found.offset;
}

// The offset was found in the interpolated truth, so stamps may lie between its poses after all.
void require_pairs(const EvalArguments& arguments, const TrajectoryPair& pair, double offset) {
  const double limit = max_difference(arguments);
  if (!associate(pair.truth, pair.estimate, limit).empty()) return;
  for (double wider = 2.0 * limit; wider <= 100.0; wider *= 2.0) {
    if (associate(pair.truth, pair.estimate, wider).empty()) continue;
    throw InputError(fmt::format(
        "with the offset of {:+.4f} s no stamps are within {:g} s, but some are within {:g} s, "
        "expected --max-difference {:g}",
        offset, limit, wider, wider));
  }
}

// A clock that is off makes every pose wrong, and nothing else would tell.
void hint_at_clocks(const EvalArguments& arguments, const TrajectoryPair& pair, double rmse) {
  if (arguments.search_offset || pair.by_index) return;
  const auto offset =
      likely_offset(pair.truth, pair.estimate, rmse, alignment_of(arguments.alignment));
  if (!offset) return;
  warn(
      "with {:+.3f} s added to the stamps of the estimate, the error would be {:.4f} m: do the "
      "clocks differ? --search-offset 1 takes that into account",
      offset->offset, offset->rmse);
}

// A length in another unit, likewise.
void hint_at_units(const EvalArguments& arguments, const TrajectoryPair& pair) {
  if (arguments.alignment != "se3") return;
  try {
    const double scale =
        evaluate_ate(pair.truth, pair.estimate, {Alignment::kSim3, max_difference(arguments)})
            .truth_from_estimate.scale();
    const char* of_truth = likely_unit(scale);
    const char* of_estimate = likely_unit(1.0 / scale);
    if (of_truth == nullptr && of_estimate == nullptr) return;
    warn(
        "the true path is {:.4g} times as long as the estimated one: is {} in {}, expected metres?",
        scale, of_truth != nullptr ? arguments.files.truth : arguments.files.estimate,
        of_truth != nullptr ? of_truth : of_estimate);
  } catch (const InputError&) {  // nothing to tell it by
  }
}

// A clock that is off so much that no pose has a partner.
void require_common_stamps(const EvalArguments& arguments, const TrajectoryPair& pair) {
  const double limit = max_difference(arguments);
  if (arguments.search_offset || !associate(pair.truth, pair.estimate, limit).empty()) return;
  const auto offset =
      likely_offset(pair.truth, pair.estimate, std::numeric_limits<double>::infinity());
  if (!offset) return;
  throw InputError(
      fmt::format("no stamps of truth and estimate are within {:g} s, but with {:+.3f} s added to "
                  "those of the estimate they fit to {:.4f} m, expected --search-offset 1",
                  limit, offset->offset, offset->rmse));
}

void evaluate_ate_command(const EvalArguments& arguments) {
  require_targets(arguments);
  TrajectoryPair pair = load_pair(arguments);
  const std::optional<double> offset = correct_clock(arguments, pair);
  if (offset) require_pairs(arguments, pair, *offset);
  require_common_stamps(arguments, pair);
  const Trajectory& truth = pair.truth;
  const Trajectory& estimate = pair.estimate;
  const AteReport report =
      evaluate_ate(truth, estimate, {alignment_of(arguments.alignment), max_difference(arguments)});
  print_header();
  print_row("ATE (m)", report.position);
  hint_at_clocks(arguments, pair, report.position.rmse);
  hint_at_units(arguments, pair);
  const std::string& alignment = arguments.alignment;
  const double scale = report.truth_from_estimate.scale();
  print("{} of {} estimated poses matched to {} true poses, alignment {}{}\n", report.pairs.size(),
        estimate.size(), truth.size(), alignment,
        alignment == "sim3" ? fmt::format(", scale {:.6f}", scale) : "");
  OutputSteps steps;
  write_json(steps, arguments.json,
             {{"metric", "ate"},
              {"unit", "m"},
              {"alignment", alignment},
              {"max_difference_s", max_difference(arguments)},
              {"time_offset_s",
               offset ? nlohmann::ordered_json(*offset) : nlohmann::ordered_json(nullptr)},
              {"truth_poses", truth.size()},
              {"estimate_poses", estimate.size()},
              {"scale", scale},
              {"position", statistics_json(report.position)}});
  if (!arguments.plot.empty()) {
    const std::string title = std::filesystem::path(arguments.files.estimate).filename().string();
    const std::string subtitle =
        fmt::format("ATE {:.4f} m rmse, {:.4f} m max over {} poses, alignment {}",
                    report.position.rmse, report.position.max, report.pairs.size(), alignment);
    steps.run([&] {
      write_file_atomically(arguments.plot,
                            draw_trajectory_svg(transformed(estimate, report.truth_from_estimate),
                                                truth, title, subtitle));
    });
  }
  steps.end_command();
}

void evaluate_rpe_command(const EvalArguments& arguments) {
  require_targets(arguments);
  const TrajectoryPair pair = load_pair(arguments);
  if (!pair.has_stamps && arguments.unit == "seconds") {
    throw InputError("--delta-unit is seconds, expected frames for poses without stamps (KITTI)");
  }
  RpeOptions options;
  options.delta = arguments.delta;
  options.unit =
      arguments.unit == "frames" ? RpeOptions::Unit::kFrames : RpeOptions::Unit::kSeconds;
  options.all_pairs = !arguments.consecutive;
  options.alignment = alignment_of(arguments.alignment);
  options.max_difference = max_difference(arguments);
  const RpeReport report = evaluate_rpe(pair.truth, pair.estimate, options);
  print_header();
  print_row("RPE (m)", report.translation);
  print_row("RPE (degrees)", report.rotation);
  print("over {:g} {}, {} pairs\n", options.delta, arguments.unit, report.translation.count);
  OutputSteps steps;
  write_json(steps, arguments.json,
             {{"metric", "rpe"},
              {"delta", options.delta},
              {"delta_unit", arguments.unit},
              {"all_pairs", options.all_pairs},
              {"alignment", arguments.alignment},
              {"max_difference_s", options.max_difference},
              {"translation_m", statistics_json(report.translation)},
              {"rotation_deg", statistics_json(report.rotation)}});
  steps.end_command();
}

// What both metrics have in common.
CLI::App* add_metric(CLI::App& eval, const char* name, const char* about,
                     const std::shared_ptr<EvalArguments>& arguments) {
  CLI::App* metric = eval.add_subcommand(name, about);
  metric
      ->add_option("GROUNDTRUTH", arguments->files.truth,
                   "true trajectory: a file (TUM, KITTI or EuRoC) or the folder of a recording")
      ->required();
  metric
      ->add_option("ESTIMATE", arguments->files.estimate,
                   "estimated trajectory: a file (TUM, KITTI or EuRoC)")
      ->required();
  metric
      ->add_option("--format", arguments->files.format,
                   "of ESTIMATE: auto (by its columns), tum, kitti or euroc")
      ->check(one_of(trajectory_format_names()))
      ->option_text("NAME");
  metric->add_option("--truth-format", arguments->files.truth_format, "of GROUNDTRUTH, likewise")
      ->check(one_of(trajectory_format_names()))
      ->option_text("NAME");
  metric->add_option("--align", arguments->alignment, "se3, sim3 (with scale) or none")
      ->check(one_of({"se3", "sim3", "none"}))
      ->option_text("se3|sim3|none");
  metric
      ->add_option("--max-difference", arguments->max_difference,
                   "largest difference of matched stamps, seconds (0.01)")
      ->check(number(0.0, 1000.0))
      ->option_text("S");
  metric->add_option("--json", arguments->json, "also write the figures to a JSON file")
      ->option_text("FILE");
  return metric;
}

}  // namespace

void add_eval_command(CLI::App& app) {
  CLI::App* eval = app.add_subcommand("eval", "compare a trajectory with the truth");
  eval->require_subcommand(1);

  const auto arguments = std::make_shared<EvalArguments>();
  CLI::App* ate =
      add_metric(*eval, "ate", "absolute trajectory error: distance of positions", arguments);
  ate->add_option("--plot", arguments->plot, "also draw both trajectories as an SVG picture")
      ->check(svg_file())
      ->option_text("FILE.svg");
  ate->add_option("--search-offset", arguments->search_offset,
                  "find the offset of the clocks, up to so many seconds, that fits best")
      ->check(number(1e-3, 100.0))
      ->option_text("S");
  ate->callback([arguments] { evaluate_ate_command(*arguments); });

  const auto relative = std::make_shared<EvalArguments>();
  relative->alignment = "none";
  CLI::App* rpe = add_metric(
      *eval, "rpe", "relative pose error: difference of motions over a fixed distance", relative);
  rpe->add_option("--delta", relative->delta, "that distance (1)")
      ->check(number(1e-6, 1e9))
      ->option_text("N");
  rpe->add_option("--delta-unit", relative->unit, "frames or seconds (frames)")
      ->check(one_of({"frames", "seconds"}))
      ->option_text("frames|seconds");
  rpe->add_flag("--consecutive", relative->consecutive,
                "let each pair begin where the last ended, not at every pose");
  rpe->callback([relative] {
    if (relative->unit == "frames" && relative->delta != std::floor(relative->delta)) {
      throw CLI::ValidationError("--delta",
                                 fmt::format("{:g} is no whole number of frames", relative->delta));
    }
    evaluate_rpe_command(*relative);
  });

  add_eval_openloris_command(*eval);
}

}  // namespace dxslam::apps
