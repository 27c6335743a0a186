// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/sim3.h"
#include "core/trajectory.h"
#include "evaluation/openloris_result.h"
#include "evaluation/statistics.h"

namespace dxslam {

// The metrics of OpenLORIS-Scene (Shi et al., ICRA 2020) as the benchmark's own evaluator computes
// them; docs/evaluation.md has the formulas.

struct OpenlorisOptions {
  /// A pose is correct if its position and its angle are wrong by no more than this: metres and
  /// degrees.
  double max_position_error = std::numeric_limits<double>::infinity();
  double max_angle_error = std::numeric_limits<double>::infinity();
  double max_pose_interval = 1.0;     ///< seconds for which one pose counts at most
  double relocalization_time = 60.0;  ///< seconds in which the re-localization score falls to 1/e
  double max_truth_gap = 0.5;         ///< seconds; poses in longer gaps of the truth do not count
  bool with_scale = false;            ///< fit the scale, too (systems without metric scale)
};

/// The benchmark's largest position error of a correct pose in the lifelong test, metres: 1 in the
/// office, 3 in home and cafe, 5 in corridor and market; 1 in scenes it does not know.
double openloris_position_threshold(const std::string& scene);

/// One estimated pose for which there is truth.
struct OpenlorisPoseError {
  double stamp = 0.0;
  double position = 0.0;  ///< metres
  double angle = 0.0;     ///< degrees
  bool correct = false;
};

struct OpenlorisSequenceReport {
  int number = 0;
  bool present = false;  ///< the result has this sequence, be it without a pose
  bool aided = false;
  std::size_t poses = 0;  ///< in the result; exactly repeated ones left out
  double begin = 0.0;     ///< first and last stamp of the truth
  double end = 0.0;
  std::vector<OpenlorisPoseError> errors;  ///< by stamp

  ErrorStatistics position;                ///< metres, all poses: ATE
  ErrorStatistics correct_position;        ///< metres, correct poses: C-ATE
  ErrorStatistics angle;                   ///< degrees, all poses
  double tracked_rate = 0.0;               ///< share of the time with a pose: CR-infinity
  double correct_rate = 0.0;               ///< share of the time with a correct pose: CR
  double correct_rate_once_started = 0.0;  ///< the same of the time from the first pose on: CR-T
  /// Seconds from the beginning to the first pose; infinity if there is none.
  double start_delay = std::numeric_limits<double>::infinity();
  /// exp(-start_delay / relocalization_time) if the first pose is correct, else 0; nothing for a
  /// system that was told its first pose.
  std::optional<double> relocalization_score;

  double duration() const { return end - begin; }
};

/// Over the sequences of a scene: rates weighted by time, errors by the number of poses.
struct OpenlorisTotals {
  double tracked_rate = 0.0;
  double correct_rate = 0.0;
  double correct_rate_once_started = 0.0;
  double correct_rate_present = 0.0;  ///< leaving out the sequences that the result does not have
  double position = 0.0;              ///< metres: ATE
  double correct_position = 0.0;      ///< metres: C-ATE
};

struct OpenlorisReport {
  std::string scene;
  std::string frame;  ///< of the estimate
  OpenlorisOptions options;
  Sim3 truth_from_estimate;                        ///< fitted to the first sequence of the result
  std::vector<OpenlorisSequenceReport> sequences;  ///< all of the truth, by number
  OpenlorisTotals totals;
};

/// Scores the sequences of a scene. The truth is moved to the frame of the estimate and
/// interpolated at the estimate's stamps. Only the lowest-numbered sequence of the result is
/// aligned, by its positions; all others have to agree with it. Where its positions lie on one line
/// or are fewer than three, its first pose is laid upon the truth; where it has none, nothing is
/// aligned. Throws InputError if the scenes differ, a frame is unknown, or a sequence has no truth.
OpenlorisReport evaluate_openloris(const OpenlorisResult& truth, const OpenlorisResult& estimate,
                                   const OpenlorisOptions& options = {});

/// The pose at `stamp` between the two poses around it, position linear, rotation spherical.
/// Nothing before the first, after the last, or if the two are `max_gap` seconds apart or more.
std::optional<SE3> interpolate(const Trajectory& trajectory, double stamp, double max_gap);

}  // namespace dxslam
