// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/commands/eval_openloris.h"
#include "apps/command_files.h"
#include "apps/commands.h"
#include "apps/console.h"
#include "apps/output_steps.h"
#include "apps/statistics_json.h"
#include "apps/usage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "evaluation/openloris.h"
#include "evaluation/openloris_svg.h"
#include "evaluation/svg.h"
#include "io/primitives/atomic_file.h"
#include "io/primitives/json_text.h"

namespace dxslam::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

struct Arguments {
  std::string truth;
  std::vector<std::string> results;
  double max_position = 0.0;  // 0 is the benchmark's for the scene
  double max_angle = 30.0;
  std::string alignment = "se3";
  std::string json;
  std::string plot;
};

// The truth of a scene: `path` itself, or in that folder the file named as the benchmark names it.
std::string truth_file(const std::string& path, const std::string& scene) {
  if (!fs::is_directory(path)) return path;
  const std::string numbered = (fs::path(path) / fmt::format("gt_{}_1.txt", scene)).string();
  if (fs::exists(numbered)) return numbered;
  throw InputError(
      fmt::format("{}: no such file, expected the truth of scene {}", numbered, scene));
}

OpenlorisReport evaluate(const Arguments& arguments, const std::string& result_file) {
  const OpenlorisResult result = read_openloris_result(result_file);
  OpenlorisOptions options;
  options.max_position_error = arguments.max_position > 0.0
                                   ? arguments.max_position
                                   : openloris_position_threshold(result.scene);
  options.max_angle_error = arguments.max_angle;
  options.with_scale = arguments.alignment == "sim3";
  const OpenlorisResult truth = read_openloris_result(truth_file(arguments.truth, result.scene));
  try {
    return evaluate_openloris(truth, result, options);
  } catch (const InputError& e) {
    throw InputError(fmt::format("{}: {}", result_file, e.what()));
  }
}

std::string thresholds(const OpenlorisOptions& options) {
  return fmt::format("correct within {:g} m and {:g} degrees", options.max_position_error,
                     options.max_angle_error);
}

// A figure, or a dash where there is nothing to measure.
std::string cell(bool measured, double value) {
  return measured ? fmt::format("{:.3f}", value) : std::string("-");
}

void print_sequence(const OpenlorisSequenceReport& s) {
  const bool matched = !s.errors.empty();
  print("{:<6} {:>7.1f} {:>7} {:>7} {:>8.3f} {:>8.3f} {:>8} {:>9} {:>9} {:>9} {:>8} {:>8}\n",
        s.number, s.duration(), s.poses, s.errors.size(), s.tracked_rate, s.correct_rate,
        cell(matched, s.correct_rate_once_started), cell(matched, s.position.rmse),
        cell(s.correct_position.count > 0, s.correct_position.rmse), cell(matched, s.angle.rmse),
        cell(matched, s.start_delay),
        cell(s.relocalization_score.has_value(), s.relocalization_score.value_or(0.0)));
}

void print_report(const std::string& file, const OpenlorisReport& report) {
  print("{}: scene {}, poses of {}, {}\n", file, report.scene, report.frame,
        thresholds(report.options));
  print("{:<6} {:>7} {:>7} {:>7} {:>8} {:>8} {:>8} {:>9} {:>9} {:>9} {:>8} {:>8}\n", "seq",
        "time s", "poses", "matched", "tracked", "correct", "CR-T", "ATE m", "C-ATE m", "AOE deg",
        "start s", "reloc");
  double duration = 0.0;
  std::size_t poses = 0;
  std::size_t matched = 0;
  bool correct = false;
  std::vector<int> absent;
  for (const OpenlorisSequenceReport& sequence : report.sequences) {
    duration += sequence.duration();
    poses += sequence.poses;
    matched += sequence.errors.size();
    correct = correct || sequence.correct_position.count > 0;
    if (sequence.present) {
      print_sequence(sequence);
    } else {
      absent.push_back(sequence.number);
    }
  }
  const OpenlorisTotals& t = report.totals;
  print("{:<6} {:>7.1f} {:>7} {:>7} {:>8.3f} {:>8.3f} {:>8} {:>9} {:>9}\n", "scene", duration,
        poses, matched, t.tracked_rate, t.correct_rate,
        cell(matched > 0, t.correct_rate_once_started), cell(matched > 0, t.position),
        cell(correct, t.correct_position));
  if (absent.empty()) return;
  print("not in the result, counted as never localized: seq {}; without them correct is {:.3f}\n",
        fmt::join(absent, ", "), t.correct_rate_present);
}

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json to_json(const OpenlorisSequenceReport& s) {
  Json json = {{"seq", s.number},
               {"present", s.present},
               {"aided", s.aided},
               {"duration_s", s.duration()},
               {"poses", s.poses},
               {"matched", s.errors.size()},
               {"tracked_rate", s.tracked_rate},
               {"correct_rate", s.correct_rate},
               {"correct_rate_once_started", s.correct_rate_once_started},
               {"ate_m", statistics_json(s.position)},
               {"c_ate_m", statistics_json(s.correct_position)},
               {"aoe_deg", statistics_json(s.angle)},
               {"start_delay_s", finite_or_null(s.start_delay)}};
  json["relocalization_score"] =
      s.relocalization_score ? Json(*s.relocalization_score) : Json(nullptr);
  return json;
}

Json to_json(const std::string& file, const OpenlorisReport& report) {
  const OpenlorisTotals& t = report.totals;
  Json sequences = Json::array();
  for (const OpenlorisSequenceReport& sequence : report.sequences) {
    sequences.push_back(to_json(sequence));
  }
  return {{"file", file},
          {"scene", report.scene},
          {"frame", report.frame},
          {"max_position_m", finite_or_null(report.options.max_position_error)},
          {"max_angle_deg", finite_or_null(report.options.max_angle_error)},
          {"scale", report.truth_from_estimate.scale()},
          {"tracked_rate", t.tracked_rate},
          {"correct_rate", t.correct_rate},
          {"correct_rate_present", t.correct_rate_present},
          {"correct_rate_once_started", t.correct_rate_once_started},
          {"ate_m", t.position},
          {"c_ate_m", t.correct_position},
          {"sequences", std::move(sequences)}};
}

// "orbslam_home.txt" is what orbslam did in the scene home.
std::string system_name(const std::string& file, const std::string& scene) {
  std::string stem = fs::path(file).stem().string();
  for (const char* separator : {"_", "-"}) {
    const std::string ending = separator + scene;
    if (stem.size() > ending.size() &&
        stem.compare(stem.size() - ending.size(), ending.size(), ending) == 0) {
      stem.resize(stem.size() - ending.size());
      break;
    }
  }
  return stem;
}

// One row per system; a second file about the same scene gets a row of its own.
void add_to_picture(std::vector<OpenlorisSystem>& systems, const std::string& file,
                    const OpenlorisReport& report) {
  const std::string name = system_name(file, report.scene);
  for (OpenlorisSystem& system : systems) {
    bool free = system.name == name;
    for (const OpenlorisReport& other : system.scenes) free = free && other.scene != report.scene;
    if (!free) continue;
    system.scenes.push_back(report);
    return;
  }
  systems.push_back({name, {report}});
}

// "3 m", or "1 m (office), 3 m (home)" where scenes differ.
std::string position_thresholds(const std::vector<OpenlorisSystem>& systems) {
  std::vector<std::string> each;
  bool differ = false;
  const double first = systems.front().scenes.front().options.max_position_error;
  for (const OpenlorisSystem& system : systems) {
    for (const OpenlorisReport& report : system.scenes) {
      const double threshold = report.options.max_position_error;
      differ = differ || threshold != first;
      const std::string text = fmt::format("{:g} m ({})", threshold, report.scene);
      if (std::find(each.begin(), each.end(), text) == each.end()) each.push_back(text);
    }
  }
  return differ ? fmt::format("{}", fmt::join(each, ", ")) : fmt::format("{:g} m", first);
}

void run(const Arguments& arguments) {
  std::vector<std::string> inputs = arguments.results;
  inputs.push_back(arguments.truth);
  CommandFiles files(inputs);
  files.writes("--json", arguments.json, report_kind());
  files.writes("--plot", arguments.plot, svg_kind());
  Json results = Json::array();
  std::vector<OpenlorisSystem> systems;
  for (const std::string& file : arguments.results) {
    const OpenlorisReport report = evaluate(arguments, file);
    if (!results.empty()) print("\n");
    print_report(file, report);
    results.push_back(to_json(file, report));
    add_to_picture(systems, file, report);
  }
  OutputSteps steps;
  if (!arguments.json.empty()) {
    const Json all = {{"metric", "openloris"}, {"results", std::move(results)}};
    steps.run([&] { write_file_atomically(arguments.json, to_json_text(all)); });
  }
  if (!arguments.plot.empty()) {
    const std::string subtitle =
        fmt::format("Correct rate above, C-ATE below; correct within {} and {:g} degrees",
                    position_thresholds(systems), arguments.max_angle);
    steps.run([&] {
      write_file_atomically(arguments.plot,
                            draw_openloris_svg(systems, "When the place was known", subtitle));
    });
  }
  steps.end_command();
}

}  // namespace

FileKind report_kind() { return json_kind("a report of `dxslam eval`", {"metric"}); }

void add_eval_openloris_command(CLI::App& eval) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = eval.add_subcommand(
      "openloris", "lifelong localization: correct rate, C-ATE and re-localization score");
  command
      ->add_option("GROUNDTRUTH", arguments->truth,
                   "truth of the scene in OpenLORIS-Scene format, or a folder of gt_SCENE_1.txt")
      ->required();
  command
      ->add_option("RESULT", arguments->results, "poses of the sequences of a scene, same format")
      ->required();
  command
      ->add_option("--max-position", arguments->max_position,
                   "largest error of a correct position, metres, or inf (1 to 5, by the scene)")
      ->check(number(1e-9, kNoLimit))
      ->option_text("M");
  command
      ->add_option("--max-angle", arguments->max_angle,
                   "largest error of a correct orientation, degrees, or inf (30)")
      ->check(number(1e-9, kNoLimit))
      ->option_text("DEG");
  command->add_option("--align", arguments->alignment, "se3 or sim3 (with scale)")
      ->check(one_of({"se3", "sim3"}))
      ->option_text("se3|sim3");
  command->add_option("--json", arguments->json, "also write the figures to a JSON file")
      ->option_text("FILE");
  command
      ->add_option("--plot", arguments->plot, "also draw when the place was known as SVG picture")
      ->check(svg_file())
      ->option_text("FILE.svg");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace dxslam::apps
