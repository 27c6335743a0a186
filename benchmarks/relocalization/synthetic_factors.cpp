// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic_factors.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <optional>

#include "relocalization/consensus.h"
#include "synthetic/synthetic_sequence.h"
#include "trial.h"

namespace dxslam::benchmark {
namespace {

constexpr double kRight = 0.3;          // metres
constexpr double kTimeConstant = 60.0;  // seconds

struct Factor {
  std::string name;
  SyntheticOptions options;
};

std::vector<Factor> factors(const SyntheticOptions& map) {
  std::vector<Factor> all;
  for (const char* name : {"viewpoint", "illumination", "low_light", "changed_objects", "people"}) {
    Factor factor{name, map};
    set_factor(factor.options.factors, name);
    all.push_back(factor);
  }
  Factor reverse{"viewpoint: the other way round", map};
  reverse.options.path.reverse = true;
  all.push_back(reverse);
  for (Factor& factor : all) factor.options.factors.seed = map.factors.seed + 1;
  return all;
}

Query query_of(SyntheticSequence& sequence, std::size_t i) {
  return {sequence.read(i).value(), sequence.ground_truth()[i].world_from_camera, SE3()};
}

// Seconds to the first accepted pose, and how far it is off.
struct FirstPose {
  double seconds = 0.0;
  double distance = 0.0;

  double score() const { return distance <= kRight ? std::exp(-seconds / kTimeConstant) : 0.0; }
};

std::optional<FirstPose> first_pose(const SyntheticTrial& trial, MapUnderTest& map,
                                    const Relocalizer& relocalizer, SyntheticSequence& sequence) {
  RelocalizationConsensus consensus;
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    const double seconds = sequence.stamp(i) - sequence.stamp(0);
    if (seconds > trial.longest) break;
    const Outcome outcome = locate(map, relocalizer, query_of(sequence, i));
    if (consensus.add(sequence.stamp(i), outcome.report)) {
      return FirstPose{seconds, outcome.global.distance};
    }
  }
  return std::nullopt;
}

void measure(const SyntheticTrial& trial, const Factor& factor, MapUnderTest& map) {
  SyntheticSequence sequence(factor.options);
  const Relocalizer relocalizer(map.camera(), map.extractor().traits(), trial.options);
  const std::optional<FirstPose> first = first_pose(trial, map, relocalizer, sequence);
  Row row{trial.scene + ": " + factor.name, kRight, 180.0, {}};
  int accepted = 0, right = 0, wrong = 0;
  for (std::size_t i = 0; i < sequence.size(); i += static_cast<std::size_t>(trial.every_query)) {
    row.outcomes.push_back(locate(map, relocalizer, query_of(sequence, i)));
    const Outcome& outcome = row.outcomes.back();
    if (!outcome.report.accepted) continue;
    ++accepted;
    right += outcome.global.distance <= kRight ? 1 : 0;
    wrong += outcome.global.distance > 0.5 ? 1 : 0;
  }
  append_csv(trial.csv, row);
  const std::size_t asked = row.outcomes.size();
  const double n = std::max(1.0, static_cast<double>(asked));
  fmt::print("| {} | {} | {} | {:.3f} | {} | {:.1f} % | {:.1f} % | {} | {} | {} |\n", factor.name,
             first ? fmt::format("{:.1f} s", first->seconds) : "-",
             first ? fmt::format("{:.3f} m", first->distance) : "-", first ? first->score() : 0.0,
             asked, 100.0 * accepted / n, 100.0 * right / n, wrong, agreement(row).accepted,
             agreement(row).wrong);
  std::fflush(stdout);
}

}  // namespace

void measure_synthetic_factors(const SyntheticTrial& trial) {
  SyntheticOptions options;
  options.scene = trial.scene;
  options.fps = trial.fps;
  SyntheticSequence sequence(options);
  MapUnderTest map(
      sequence, trial.make_extractor(), [](std::size_t, const RgbdSequence&) { return true; },
      0.05);
  fmt::print("\n{}: map of {} keyframes, {:.1f} m walked\n\n", trial.scene,
             map.map().keyframe_count(), sequence.path_length());
  fmt::print(
      "| factor | first pose after | off by | re-localization score | isolated images | accepted | "
      "right within 0.3 m | wrong by > 0.5 m | by three in a row | of these wrong "
      "|\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Factor& factor : factors(options)) {
    if (factor.name.find(trial.only) != std::string::npos) measure(trial, factor, map);
  }
}

}  // namespace dxslam::benchmark
