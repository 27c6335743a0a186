// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <optional>
#include <string>

#include "io/recordings/sequence_reader.h"
#include "slam/system_options.h"

namespace dxslam::apps {

/// What `dxslam run` was asked for.
struct RunSettings {
  std::string sequence;
  SequenceOptions reader;
  std::string config;
  std::string features;
  std::string out;
  std::string mode;        ///< "": as configured
  std::string vocabulary;  ///< "": as configured
  std::string map_in;
  std::string map_out;
  int autosave = 0;         ///< keyframes between two saves of map_out; 0: only at the end
  bool thumbnails = false;  ///< pictures of the keyframes into map_out
  bool no_loop_closing = false;
  std::size_t stride = 1;
  std::size_t max_frames = 0;  ///< 0: all
  std::optional<double> low_light;
  bool realtime = false;
  bool deterministic = false;
};

/// How a run went, beside what the system itself reports.
struct RunRecord {
  double startup_ms = 0.0;  ///< from the start of the command to the first image
  /// From the start of the command to the first pose of a frame.
  std::optional<double> first_pose_ms;
  double wall_s = 0.0;  ///< from the first image to the last result
  std::size_t frames_offered = 0;
  std::size_t frames_dropped = 0;  ///< real time only: the system was busy
  bool interrupted = false;
};

}  // namespace dxslam::apps
