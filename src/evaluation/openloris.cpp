// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/openloris.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "evaluation/association.h"
#include "io/recordings/openloris_sensors.h"

namespace dxslam {
namespace {

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

bool equal(const SE3& a, const SE3& b) {
  return a.translation() == b.translation() && a.rotation().coeffs() == b.rotation().coeffs();
}

// The evaluator takes an exactly repeated pose for a system that has stopped and counts it once, in
// the truth as well.
Trajectory without_repeats(const Trajectory& trajectory) {
  Trajectory kept;
  for (const StampedPose& pose : trajectory) {
    if (!kept.empty() && equal(kept.back().world_from_camera, pose.world_from_camera)) continue;
    kept.push_back(pose);
  }
  return kept;
}

Trajectory moved(const Trajectory& world_from_a, const SE3& a_from_b) {
  Trajectory world_from_b = world_from_a;
  for (StampedPose& pose : world_from_b) pose.world_from_camera = pose.world_from_camera * a_from_b;
  return world_from_b;
}

// How the sensor of the estimate sits on that of the truth.
SE3 truth_frame_from_estimate_frame(const OpenlorisResult& truth, const OpenlorisResult& estimate) {
  if (truth.frame == estimate.frame) return {};
  const bool market = truth.scene == "market";
  return openloris_base_from_sensor(market, truth.frame).inverse() *
         openloris_base_from_sensor(market, estimate.frame);
}

std::vector<PosePair> pairs_of(const Trajectory& truth, const Trajectory& estimate,
                               double max_gap) {
  std::vector<PosePair> pairs;
  for (const StampedPose& pose : estimate) {
    const auto there = interpolate(truth, pose.stamp, max_gap);
    if (there) pairs.push_back({{pose.stamp, *there}, pose});
  }
  return pairs;
}

Sim3 align_sequence(const std::vector<PosePair>& pairs, bool with_scale) {
  if (pairs.empty()) return {};
  try {
    return align(pairs, with_scale ? Alignment::kSim3 : Alignment::kSe3);
  } catch (const InputError&) {  // Too few poses, or all on one line.
    const PosePair& first = pairs.front();
    return Sim3(first.truth.world_from_camera * first.estimate.world_from_camera.inverse());
  }
}

// One sequence on its way to a report.
struct Matched {
  OpenlorisSequenceReport report;
  std::vector<PosePair> pairs;
};

Matched match(const OpenlorisSequence& truth, const OpenlorisSequence* estimate,
              const SE3& truth_frame_from_frame, const OpenlorisOptions& options) {
  const Trajectory poses = without_repeats(truth.poses);
  if (poses.size() < 2) {
    throw InputError(
        fmt::format("the truth of sequence {} has {} different poses, expected at least two",
                    truth.number, poses.size()));
  }
  if (!(poses.back().stamp > poses.front().stamp)) {
    throw InputError(
        fmt::format("the truth of sequence {} begins and ends at {:.6f} s, expected some time",
                    truth.number, poses.front().stamp));
  }
  Matched matched;
  OpenlorisSequenceReport& report = matched.report;
  report.number = truth.number;
  report.begin = poses.front().stamp;
  report.end = poses.back().stamp;
  if (estimate == nullptr) return matched;
  report.present = true;
  report.aided = estimate->aided;
  const Trajectory estimated = without_repeats(estimate->poses);
  report.poses = estimated.size();
  matched.pairs = pairs_of(moved(poses, truth_frame_from_frame), estimated, options.max_truth_gap);
  return matched;
}

std::vector<OpenlorisPoseError> errors_of(const std::vector<PosePair>& pairs,
                                          const Sim3& truth_from_estimate,
                                          const OpenlorisOptions& options) {
  std::vector<OpenlorisPoseError> errors;
  for (const PosePair& pair : pairs) {
    const SE3 aligned = transformed({pair.estimate}, truth_from_estimate).front().world_from_camera;
    OpenlorisPoseError error;
    error.stamp = pair.estimate.stamp;
    error.position = translation_distance(pair.truth.world_from_camera, aligned);
    error.angle = kDegrees * rotation_angle(pair.truth.world_from_camera, aligned);
    error.correct =
        error.position <= options.max_position_error && error.angle <= options.max_angle_error;
    errors.push_back(error);
  }
  return errors;
}

void summarise_errors(OpenlorisSequenceReport& report) {
  std::vector<double> position;
  std::vector<double> correct;
  std::vector<double> angle;
  for (const OpenlorisPoseError& error : report.errors) {
    position.push_back(error.position);
    angle.push_back(error.angle);
    if (error.correct) correct.push_back(error.position);
  }
  report.position = summarise(position);
  report.correct_position = summarise(correct);
  report.angle = summarise(angle);
}

// Each pose stands for the time until the next, but not for longer than max_pose_interval.
void measure_time(OpenlorisSequenceReport& report, const OpenlorisOptions& options) {
  double tracked = 0.0;
  double correct = 0.0;
  for (std::size_t i = 0; i < report.errors.size(); ++i) {
    const bool last = i + 1 == report.errors.size();
    const double until = last ? report.end : report.errors[i + 1].stamp;
    const double time = std::min(until - report.errors[i].stamp, options.max_pose_interval);
    tracked += time;
    if (report.errors[i].correct) correct += time;
  }
  report.tracked_rate = tracked / report.duration();
  report.correct_rate = correct / report.duration();
  if (!report.errors.empty()) {
    const double left = report.end - report.errors.front().stamp;
    report.correct_rate_once_started = left > 0.0 ? correct / left : 0.0;
    report.start_delay = std::max(0.0, report.errors.front().stamp - report.begin);
  }
  if (report.aided) return;
  const bool well_started = !report.errors.empty() && report.errors.front().correct;
  report.relocalization_score =
      well_started ? std::exp(-report.start_delay / options.relocalization_time) : 0.0;
}

double ratio(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

OpenlorisTotals totals_of(const std::vector<OpenlorisSequenceReport>& sequences) {
  double duration = 0.0;
  double duration_present = 0.0;
  double started = 0.0;
  double tracked = 0.0;
  double correct = 0.0;
  double poses = 0.0;
  double correct_poses = 0.0;
  OpenlorisTotals totals;
  for (const OpenlorisSequenceReport& sequence : sequences) {
    duration += sequence.duration();
    if (!sequence.present) continue;
    duration_present += sequence.duration();
    tracked += sequence.tracked_rate * sequence.duration();
    correct += sequence.correct_rate * sequence.duration();
    if (!sequence.errors.empty()) started += sequence.end - sequence.errors.front().stamp;
    const auto count = static_cast<double>(sequence.position.count);
    const auto correct_count = static_cast<double>(sequence.correct_position.count);
    poses += count;
    correct_poses += correct_count;
    totals.position += count * sequence.position.rmse;
    totals.correct_position += correct_count * sequence.correct_position.rmse;
  }
  totals.tracked_rate = ratio(tracked, duration);
  totals.correct_rate = ratio(correct, duration);
  totals.correct_rate_present = ratio(correct, duration_present);
  totals.correct_rate_once_started = ratio(correct, started);
  totals.position = ratio(totals.position, poses);
  totals.correct_position = ratio(totals.correct_position, correct_poses);
  return totals;
}

const OpenlorisSequence* find(const std::vector<OpenlorisSequence>& sequences, int number) {
  for (const OpenlorisSequence& sequence : sequences) {
    if (sequence.number == number) return &sequence;
  }
  return nullptr;
}

void check_same_scene(const OpenlorisResult& truth, const OpenlorisResult& estimate) {
  if (truth.scene != estimate.scene) {
    throw InputError(fmt::format("the result is of scene {}, the truth of {}, expected the same",
                                 estimate.scene, truth.scene));
  }
  for (const OpenlorisSequence& sequence : estimate.sequences) {
    if (find(truth.sequences, sequence.number) != nullptr) continue;
    throw InputError(fmt::format("sequence {} of scene {} has no truth, expected one of {} to {}",
                                 sequence.number, truth.scene, truth.sequences.front().number,
                                 truth.sequences.back().number));
  }
}

}  // namespace

double openloris_position_threshold(const std::string& scene) {
  if (scene == "home" || scene == "cafe") return 3.0;
  if (scene == "corridor" || scene == "market") return 5.0;
  return 1.0;
}

std::optional<SE3> interpolate(const Trajectory& trajectory, double stamp, double max_gap) {
  const auto after =
      std::upper_bound(trajectory.begin(), trajectory.end(), stamp,
                       [](double value, const StampedPose& pose) { return value < pose.stamp; });
  if (after == trajectory.begin()) return std::nullopt;
  const StampedPose& before = *std::prev(after);
  if (before.stamp == stamp) return before.world_from_camera;
  if (after == trajectory.end() || after->stamp - before.stamp >= max_gap) return std::nullopt;
  const double share = (stamp - before.stamp) / (after->stamp - before.stamp);
  const SE3& a = before.world_from_camera;
  const SE3& b = after->world_from_camera;
  return SE3(a.rotation().slerp(share, b.rotation()),
             (1.0 - share) * a.translation() + share * b.translation());
}

OpenlorisReport evaluate_openloris(const OpenlorisResult& truth, const OpenlorisResult& estimate,
                                   const OpenlorisOptions& options) {
  require(!truth.sequences.empty() && !estimate.sequences.empty(), "there is nothing to evaluate");
  check_same_scene(truth, estimate);
  OpenlorisReport report;
  report.scene = estimate.scene;
  report.frame = estimate.frame;
  report.options = options;
  const SE3 truth_frame_from_frame = truth_frame_from_estimate_frame(truth, estimate);
  std::vector<Matched> all;
  for (const OpenlorisSequence& sequence : truth.sequences) {
    const OpenlorisSequence* estimated = find(estimate.sequences, sequence.number);
    all.push_back(match(sequence, estimated, truth_frame_from_frame, options));
    if (estimated == &estimate.sequences.front()) {
      report.truth_from_estimate = align_sequence(all.back().pairs, options.with_scale);
    }
  }
  for (Matched& matched : all) {
    matched.report.errors = errors_of(matched.pairs, report.truth_from_estimate, options);
    summarise_errors(matched.report);
    measure_time(matched.report, options);
    report.sequences.push_back(std::move(matched.report));
  }
  report.totals = totals_of(report.sequences);
  return report;
}

}  // namespace dxslam
