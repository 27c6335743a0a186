// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/online_trajectory.h"
#include "apps/output_steps.h"
#include "apps/recording_report.h"
#include "apps/session.h"
#include "core/sequence.h"

namespace dxslam::apps {

/// How `dxslam run` went, beside what the system itself reports.
struct RunRecord {
  std::optional<double> low_light;  ///< gain that the images were darkened by
  bool realtime = false;
  double startup_ms = 0.0;  ///< from the start of the command to the first image
  /// From the start of the command to the first pose of a frame.
  std::optional<double> first_pose_ms;
  double wall_s = 0.0;  ///< from the first image to the last result
  std::size_t frames_offered = 0;
  std::vector<SkippedFrame> failed_images;
  std::size_t frames_dropped = 0;  ///< real time only: the system was busy
  std::size_t frames_tracked = 0;  ///< in any map
  std::size_t maps = 0;            ///< in which they were
  bool interrupted = false;
  Trajectory trajectory;  ///< in the map in which most frames were tracked
  std::optional<TruthReport> truth;
  std::optional<std::string> why_no_pose;
  std::optional<std::string> error;  ///< what ended the images early
  CallbackFailures reader_failures;
};

/// Writes trajectory.txt, keyframes.txt, map.ply, trajectory.svg and summary.json into the folder
/// of the session, if it has one, each atomically and each whatever became of the others; without
/// keyframes.txt and map.ply where the map is not whole. The poses
/// as they were known while running move to trajectory_online.txt. Last results give way to these.
void write_results(OutputSteps& steps, Session& session, OnlineTrajectory& online,
                   const RunRecord& record, const ImageOrigin& sequence);

}  // namespace dxslam::apps
