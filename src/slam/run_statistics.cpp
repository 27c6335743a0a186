// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/run_statistics.h"

namespace dxslam {

void RunStatistics::add(const Event& event) {
  if (const auto* tracked = std::get_if<FrameTracked>(&event)) add_frame(*tracked);
  if (const auto* mapped = std::get_if<KeyframeMapped>(&event)) add_keyframe(*mapped);
  if (const auto* ended = std::get_if<RecordingEnded>(&event)) {
    map_sizes_[ended->number] = {ended->keyframes, ended->points};
  }
  if (const auto* finished = std::get_if<RunFinished>(&event)) {
    times_.add("full_bundle", finished->final_bundle_ms);
  }
}

void RunStatistics::add_frame(const FrameTracked& tracked) {
  times_.add("extract", tracked.extract_ms);
  times_.add("track", tracked.track_ms);
  times_.add("frame", tracked.extract_ms + tracked.track_ms);
  if (tracked.relocalize_ms) times_.add("relocalize", *tracked.relocalize_ms);
  if (tracked.request_dropped) ++mapping_.dropped_requests;
}

void RunStatistics::add_keyframe(const KeyframeMapped& mapped) {
  times_.add("map_insert", mapped.insert_ms);
  times_.add("map_refine", mapped.refine_ms);
  times_.add("loop_closing", mapped.loop_closing_ms);
  const MappingReport& report = mapped.report;
  ++mapping_.keyframes;
  mapping_.new_points += report.new_points;
  mapping_.triangulated_points += report.triangulated_points;
  mapping_.fused_points += report.fused_points;
  mapping_.culled_points += report.culled_points;
  mapping_.culled_keyframes += static_cast<int>(report.culled_keyframes.size());
  mapping_.bundle_keyframes += report.bundle_keyframes;
  mapping_.bundle_observations += report.bundle_observations;
  mapping_.outlier_observations += report.outlier_observations;
}

}  // namespace dxslam
