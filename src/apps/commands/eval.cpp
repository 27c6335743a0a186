// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/commands.h"
#include "apps/commands/eval_openloris.h"
#include "apps/console.h"
#include "apps/statistics_json.h"
#include "apps/usage.h"
#include "core/error.h"
#include "evaluation/ate.h"
#include "evaluation/rpe.h"
#include "evaluation/trajectory_svg.h"
#include "io/formats/trajectory_file.h"
#include "io/primitives/atomic_file.h"
#include "io/primitives/json_text.h"
#include "io/recordings/sequence_reader.h"

namespace dxslam::apps {
namespace {

struct EvalArguments {
  std::string truth;
  std::string estimate;
  std::string json;
  std::string plot;
  std::string alignment = "se3";
  double max_difference = 0.01;
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

void write_json(const std::string& path, const nlohmann::ordered_json& report) {
  if (!path.empty()) write_file_atomically(path, to_json_text(report));
}

void evaluate_ate_command(const EvalArguments& arguments) {
  const Trajectory truth = load_ground_truth(arguments.truth);
  const Trajectory estimate = read_trajectory(arguments.estimate);
  const AteReport report =
      evaluate_ate(truth, estimate, {alignment_of(arguments.alignment), arguments.max_difference});
  print_header();
  print_row("ATE (m)", report.position);
  const std::string& alignment = arguments.alignment;
  const double scale = report.truth_from_estimate.scale();
  print("{} of {} estimated poses matched to {} true poses, alignment {}{}\n", report.pairs.size(),
        estimate.size(), truth.size(), alignment,
        alignment == "sim3" ? fmt::format(", scale {:.6f}", scale) : "");
  write_json(arguments.json, {{"metric", "ate"},
                              {"unit", "m"},
                              {"alignment", alignment},
                              {"max_difference_s", arguments.max_difference},
                              {"truth_poses", truth.size()},
                              {"estimate_poses", estimate.size()},
                              {"scale", scale},
                              {"position", statistics_json(report.position)}});
  if (arguments.plot.empty()) return;
  const std::string title = std::filesystem::path(arguments.estimate).filename().string();
  write_file_atomically(
      arguments.plot,
      draw_trajectory_svg(
          transformed(estimate, report.truth_from_estimate), truth, title,
          fmt::format("ATE {:.4f} m rmse, {:.4f} m max over {} poses, alignment {}",
                      report.position.rmse, report.position.max, report.pairs.size(), alignment)));
}

void evaluate_rpe_command(const EvalArguments& arguments) {
  const Trajectory truth = load_ground_truth(arguments.truth);
  const Trajectory estimate = read_trajectory(arguments.estimate);
  RpeOptions options;
  options.delta = arguments.delta;
  options.unit =
      arguments.unit == "frames" ? RpeOptions::Unit::kFrames : RpeOptions::Unit::kSeconds;
  options.all_pairs = !arguments.consecutive;
  options.alignment = alignment_of(arguments.alignment);
  options.max_difference = arguments.max_difference;
  const RpeReport report = evaluate_rpe(truth, estimate, options);
  print_header();
  print_row("RPE (m)", report.translation);
  print_row("RPE (degrees)", report.rotation);
  print("over {:g} {}, {} pairs\n", options.delta, arguments.unit, report.translation.count);
  write_json(arguments.json, {{"metric", "rpe"},
                              {"delta", options.delta},
                              {"delta_unit", arguments.unit},
                              {"all_pairs", options.all_pairs},
                              {"alignment", arguments.alignment},
                              {"max_difference_s", options.max_difference},
                              {"translation_m", statistics_json(report.translation)},
                              {"rotation_deg", statistics_json(report.rotation)}});
}

// What both metrics have in common.
CLI::App* add_metric(CLI::App& eval, const char* name, const char* about,
                     const std::shared_ptr<EvalArguments>& arguments) {
  CLI::App* metric = eval.add_subcommand(name, about);
  metric
      ->add_option("GROUNDTRUTH", arguments->truth,
                   "true trajectory: a file in TUM format or the folder of a recording")
      ->required();
  metric->add_option("ESTIMATE", arguments->estimate, "estimated trajectory in TUM format")
      ->required();
  metric->add_option("--align", arguments->alignment, "se3, sim3 (with scale) or none")
      ->check(CLI::IsMember({"se3", "sim3", "none"}))
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
      ->option_text("FILE.svg");
  ate->callback([arguments] { evaluate_ate_command(*arguments); });

  const auto relative = std::make_shared<EvalArguments>();
  relative->alignment = "none";
  CLI::App* rpe = add_metric(
      *eval, "rpe", "relative pose error: difference of motions over a fixed distance", relative);
  rpe->add_option("--delta", relative->delta, "that distance (1)")
      ->check(number(1e-6, 1e9))
      ->option_text("N");
  rpe->add_option("--delta-unit", relative->unit, "frames or seconds (frames)")
      ->check(CLI::IsMember({"frames", "seconds"}))
      ->option_text("frames|seconds");
  rpe->add_flag("--consecutive", relative->consecutive,
                "let each pair begin where the last ended, not at every pose");
  rpe->callback([relative] { evaluate_rpe_command(*relative); });

  add_eval_openloris_command(*eval);
}

}  // namespace dxslam::apps
