// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/loops_output.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "evaluation/statistics.h"
#include "evaluation/svg.h"
#include "io/primitives/atomic_file.h"
#include "io/primitives/json_text.h"

namespace dxslam::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

const char* to_string(PairTruth truth) {
  switch (truth) {
    case PairTruth::kSame:
      return "same";
    case PairTruth::kUnclear:
      return "unclear";
    default:
      return "different";
  }
}

std::string number_or_empty(double value) {
  return std::isfinite(value) ? fmt::format("{:.6f}", value) : std::string();
}

Json number_or_null(double value) {
  return std::isfinite(value) ? Json(std::round(value * 1e6) / 1e6) : Json();
}

std::string candidates_csv(const MethodRun& run, const LoopTruth& truth) {
  std::string out =
      "query,match,bow_score,global_distance,accepted,rank,inliers,confidence,truth,reason\n";
  for (const LoopQuery& query : run.queries) {
    std::size_t rank = 0;
    for (const LoopCandidate& c : query.candidates) {
      out += fmt::format("{},{},{:.6f},{},{},{},{},{:.6f},{},{}\n", query.frame, c.id, c.bow_score,
                         number_or_empty(c.global_distance), c.accepted() ? 1 : 0, ++rank,
                         c.inliers < 0 ? std::string() : std::to_string(c.inliers), c.confidence,
                         to_string(truth.at(query.frame, c.id)), dxslam::to_string(c.verdict));
    }
  }
  return out;
}

std::string curve_csv(const LoopCurve& curve) {
  std::string out = "confidence,precision,recall,right,wrong\n";
  for (const PrecisionRecall& p : curve.points) {
    out += fmt::format("{:.6f},{:.6f},{},{},{}\n", p.confidence, p.precision,
                       number_or_empty(p.recall), p.right, p.wrong);
  }
  return out;
}

double median(const std::vector<double>& values) { return summarise(values).median; }

/// What the thresholds of the options made of the queries.
Json accepted_loops(const MethodRun& run, const LoopTruth& truth) {
  Json counts = {{"same", 0}, {"different", 0}, {"unclear", 0}};
  for (const LoopQuery& query : run.queries) {
    if (query.candidates.empty() || !query.candidates.front().accepted()) continue;
    Json& count = counts[to_string(truth.at(query.frame, query.candidates.front().id))];
    count = count.get<int>() + 1;
  }
  return counts;
}

Json summary_of(const LoopSettings& settings, const LoopExperiment& experiment,
                const LoopTruth& truth, const MethodRun& run, const LoopCurve& curve,
                const std::string& name) {
  std::vector<double> times;
  for (const LoopQuery& query : run.queries) times.push_back(query.ms);
  const LoopMethod method = parse_loop_method(run.options.method);
  Json summary;
  summary["sequence"] = name;
  summary["method"] = method.name;
  summary["features"] = method.orb ? "orb" : experiment.hf_name;
  summary["vocabulary_words"] = run.words;
  summary["queries"] = experiment.queries.size();
  summary["places"] = experiment.places.size();
  summary["queries_with_loop"] = curve.queries_with_loop;
  summary["recall_at_100_precision"] = number_or_null(curve.recall_at_100_precision);
  summary["confidence_at_100_precision"] = number_or_null(curve.confidence_at_100_precision);
  summary["average_precision"] = number_or_null(curve.average_precision);
  summary["interrupted"] = experiment.interrupted;
  summary["accepted"] = accepted_loops(run, truth);
  summary["median_query_ms"] = number_or_null(median(times));
  summary["median_extraction_ms"] =
      number_or_null(median(method.orb ? experiment.orb_ms : experiment.hf_ms));
  summary["ground_truth"] = settings.truth;
  if (settings.truth == "poses") {
    summary["radius_m"] = settings.poses.radius;
    summary["angle_deg"] = settings.poses.angle;
    summary["unclear_factor"] = settings.poses.unclear;
    summary["unclear_overlap"] = settings.poses.overlap;
  }
  summary["window_s"] = settings.poses.window;
  if (settings.low_light_from) summary["low_light_from"] = *settings.low_light_from;
  if (settings.second_pass_from) summary["second_pass_from"] = *settings.second_pass_from;
  summary["candidates"] = run.options.candidates;
  return summary;
}

void write(const fs::path& path, const std::string& text) {
  write_file_atomically(path.string(), text);
}

std::string subtitle(const LoopSettings& settings, const LoopExperiment& experiment,
                     const std::vector<NamedCurve>& curves) {
  return fmt::format("{} queries, {} of them with a true loop{}", experiment.queries.size(),
                     curves.empty() ? 0 : curves.front().curve.queries_with_loop,
                     settings.low_light_from
                         ? fmt::format("; low light from frame {}", *settings.low_light_from)
                         : std::string());
}

}  // namespace

std::vector<NamedCurve> judge_methods(const LoopExperiment& experiment, const LoopTruth& truth) {
  const std::size_t loops = count_queries_with_loop(truth, experiment.queries, experiment.places);
  std::vector<NamedCurve> curves;
  for (const MethodRun& run : experiment.runs) {
    std::vector<LoopGuess> guesses;
    for (const LoopQuery& query : run.queries) {
      if (query.candidates.empty()) continue;
      const LoopCandidate& best = query.candidates.front();
      guesses.push_back({query.frame, best.id, best.confidence});
    }
    curves.push_back({run.options.method, evaluate_loops(guesses, truth, loops)});
  }
  return curves;
}

ResultFiles loop_result_files() {
  return {{{"candidates.csv", kind_by_beginning("a table of `dxslam loops`", {"query,match,"})},
           {"pr.csv", kind_by_beginning("a curve of `dxslam loops`", {"confidence,precision,"})},
           {"pr.svg", svg_kind()},
           {"summary.json", json_kind("a summary of `dxslam loops`", {"sequence", "method"})}},
          {"summary.json"},
          {"summary.json"},
          loop_method_names()};
}

void write_loop_results(OutputSteps& steps, ResultFolder& out, const LoopSettings& settings,
                        const LoopExperiment& experiment, const LoopTruth& truth,
                        const std::vector<NamedCurve>& curves, const std::string& name) {
  if (!steps.run([&] { out.begin(); })) return;
  const bool several = curves.size() > 1;
  const std::string note = subtitle(settings, experiment, curves);
  Json all = Json::array();
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const MethodRun& run = experiment.runs[i];
    const fs::path folder = several ? fs::path(out.path()) / curves[i].name : fs::path(out.path());
    if (!steps.run([&] { make_folder(folder.string()); })) continue;
    const Json summary = summary_of(settings, experiment, truth, run, curves[i].curve, name);
    all.push_back(summary);
    steps.run([&] { write(folder / "candidates.csv", candidates_csv(run, truth)); });
    steps.run([&] { write(folder / "pr.csv", curve_csv(curves[i].curve)); });
    steps.run([&] { write(folder / "pr.svg", draw_loop_curves_svg({curves[i]}, name, note)); });
    steps.run([&] { write(folder / "summary.json", to_json_text(summary)); });
  }
  if (several) {
    steps.run([&] { write(out.file("pr.svg"), draw_loop_curves_svg(curves, name, note)); });
    steps.run([&] { write(out.file("summary.json"), to_json_text(all)); });
  }
}

}  // namespace dxslam::apps
