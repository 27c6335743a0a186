// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/run_output.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/core/version.hpp>
#include <utility>

#include "apps/console.h"
#include "apps/recording_report.h"
#include "apps/system_setup.h"
#include "core/error.h"
#include "evaluation/ate.h"
#include "evaluation/trajectory_svg.h"
#include "io/formats/options_yaml.h"
#include "io/formats/ply_file.h"
#include "io/formats/trajectory_file.h"
#include "io/primitives/atomic_file.h"
#include "io/primitives/json_text.h"
#include "slam/system_setup.h"

namespace dxslam::apps {
namespace {

using Json = nlohmann::ordered_json;

double rounded(double value, double step) { return std::round(value / step) * step; }

double peak_memory_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

// Runs of frames without a pose.
Json lost_intervals(const System& system) {
  Json intervals = Json::array();
  bool lost = false;
  system.frames().for_each([&](const TrackedFrame& frame) {
    const bool was_lost = std::exchange(lost, frame.state != TrackingState::kTracking);
    if (!lost) return;
    if (!was_lost) {
      intervals.push_back({{"first_frame", frame.index},
                           {"last_frame", frame.index},
                           {"frames", 0},
                           {"first_stamp", frame.stamp},
                           {"last_stamp", frame.stamp}});
    }
    Json& interval = intervals.back();
    interval["last_frame"] = frame.index;
    interval["frames"] = interval["frames"].get<int>() + 1;
    interval["last_stamp"] = frame.stamp;
  });
  return intervals;
}

Json stage_table(const RunStatistics& statistics) {
  Json stages = Json::object();
  for (const auto& [stage, s] : statistics.stages()) {
    stages[stage] = {{"count", s.count},
                     {"median_ms", rounded(s.median_ms, 1e-3)},
                     {"p95_ms", rounded(s.p95_ms, 1e-3)},
                     {"max_ms", rounded(s.max_ms, 1e-3)},
                     {"total_ms", rounded(s.total_ms, 1e-3)}};
  }
  return stages;
}

Json skipped_frames(const ImageOrigin& sequence, const RunRecord& record) {
  Json skipped = Json::array();
  for (const SkippedFrame& s : all_skipped(sequence, record.failed_images)) {
    skipped.push_back({{"frame", s.index}, {"reason", s.reason}});
  }
  return skipped;
}

Json mapping_table(const MappingTotals& m) {
  return {{"keyframes_made", m.keyframes},
          {"keyframes_culled", m.culled_keyframes},
          {"points_from_depth", m.new_points},
          {"points_triangulated", m.triangulated_points},
          {"points_fused", m.fused_points},
          {"points_culled", m.culled_points},
          {"bundle_keyframes", m.bundle_keyframes},
          {"bundle_observations", m.bundle_observations},
          {"outlier_observations", m.outlier_observations},
          {"requests_dropped", m.dropped_requests}};
}

Json components_table(const System& system) {
  Json all = Json::array();
  for (const ComponentSummary& c : system.components()) {
    all.push_back({{"component", c.component},
                   {"keyframes", c.keyframes},
                   {"points", c.points},
                   {"tracked_frames", c.frames}});
  }
  return all;
}

Json loop_table(const System& system) {
  Json candidates = Json::array();
  const LoopLog& log = system.loop_log();
  for (const LoopRecord& r : log.records()) {
    candidates.push_back({{"frame", r.frame},
                          {"query", r.query},
                          {"candidate", r.candidate},
                          {"bow_score", rounded(r.bow_score, 1e-4)},
                          {"global_distance", std::isfinite(r.global_distance)
                                                  ? Json(rounded(r.global_distance, 1e-4))
                                                  : Json(nullptr)},
                          {"accepted", r.accepted},
                          {"verdict", r.verdict},
                          {"effect", r.effect},
                          {"inliers", r.inliers},
                          {"found_share", rounded(r.found_share, 1e-4)},
                          {"covered_share", rounded(r.covered_share, 1e-4)},
                          {"confirmations", r.confirmations},
                          {"contradiction_m", rounded(r.contradiction, 1e-4)},
                          {"largest_move_m", rounded(r.largest_move, 1e-4)}});
  }
  return {{"method", system.loop_method()},
          {"accepted", log.accepted()},
          {"corrections", log.corrections()},
          {"candidates_left_out", log.forgotten()},
          {"candidates", candidates}};
}

// What the system tells. The frames may be in a file, which may fail.
void add_system(OutputSteps& steps, Json& summary, const System& system,
                const RunStatistics& statistics) {
  summary["features"] = system.extractor().name();
  summary["lost_intervals"] = nullptr;
  steps.run([&] { summary["lost_intervals"] = lost_intervals(system); });
  if (system.map_is_whole()) {
    summary["keyframes"] = system.map().keyframe_count();
    summary["points"] = system.map().point_count();
  }
  summary["mapping"] = mapping_table(statistics.mapping());
  summary["components"] = nullptr;
  if (system.map_is_whole()) {
    steps.run([&] { summary["components"] = components_table(system); });
  }
  summary["loops"] = loop_table(system);
  summary["stages"] = stage_table(statistics);
}

void add_configuration(Json& summary, const RunSettings& settings, const SystemOptions& options) {
  summary["mode"] = options.mode;
  summary["stride"] = settings.stride;
  summary["deterministic"] = options.deterministic;
  summary["seed"] = options.tracking.pnp.seed;
  summary["libraries"] = {{"opencv", CV_VERSION},
                          {"eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION,
                                                EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)}};
  summary["configuration"] = dump_options_yaml(options);
}

void add_times(Json& summary, const RunRecord& record, double offered) {
  summary["startup_ms"] = rounded(record.startup_ms, 1e-3);
  summary["first_pose_ms"] =
      record.first_pose_ms ? Json(rounded(*record.first_pose_ms, 1e-3)) : Json(nullptr);
  summary["wall_s"] = rounded(record.wall_s, 1e-3);
  summary["frames_per_second"] = rounded(record.wall_s > 0.0 ? offered / record.wall_s : 0.0, 1e-2);
  summary["peak_memory_mib"] = rounded(peak_memory_mib(), 0.1);
}

Json failed_outputs(const OutputSteps& steps, const RunRecord& record) {
  Json failed = steps.failures();
  if (record.error) failed.erase(0);
  return failed;
}

Json summarise(OutputSteps& steps, const Session& session, const RunRecord& record,
               const ImageOrigin& sequence) {
  const double offered = static_cast<double>(std::max<std::size_t>(1, record.frames_offered));
  Json summary;
  summary["version"] = DXSLAM_VERSION;
  summary["sequence"] = sequence.name();
  summary.update(recording_json(sequence));
  summary["frames"] = record.frames_offered;
  summary["tracked"] = record.frames_tracked;
  summary["tracked_share"] = static_cast<double>(record.frames_tracked) / offered;
  summary["no_pose_reason"] = record.why_no_pose ? Json(*record.why_no_pose) : Json(nullptr);
  summary["ate"] = truth_json(record.truth);
  summary["skipped_frames"] = skipped_frames(sequence, record);
  summary["dropped_frames"] = record.frames_dropped;
  summary["interrupted"] = record.interrupted;
  summary["error"] = record.error ? Json(*record.error) : Json(nullptr);
  summary["callback_failures"] = record.reader_failures.count;
  summary["low_light_gain"] = record.low_light ? Json(*record.low_light) : Json(nullptr);
  summary["realtime"] = record.realtime;
  if (session.system() != nullptr) {
    add_system(steps, summary, *session.system(), session.statistics());
    summary["notes"] = feature_notes(session.options(), session.system()->extractor(),
                                     !session.settings().map_in.empty());
  }
  add_times(summary, record, offered);
  add_configuration(summary, session.settings(), session.options());
  return summary;
}

// Top view beside the truth. The map's own frame starts at the first camera, so the estimate is
// aligned first; where that cannot be done it is drawn alone.
std::string draw_result(const Trajectory& estimate, const ImageOrigin& sequence) {
  const Trajectory& truth = sequence.ground_truth();
  if (truth.empty()) return draw_trajectory_svg(estimate, {}, sequence.name());
  try {
    const AteReport ate = evaluate_ate(truth, estimate);
    Trajectory aligned = estimate;
    for (StampedPose& pose : aligned) {
      pose.world_from_camera = ate.truth_from_estimate.rigid() * pose.world_from_camera;
    }
    return draw_trajectory_svg(aligned, truth, sequence.name());
  } catch (const InputError&) {
    return draw_trajectory_svg(estimate, {}, sequence.name());
  }
}

void write_map(const std::string& path, const Map& map) {
  std::vector<PlyPoint> points;
  for (const PointId id : map.point_ids()) {
    const MapPoint& p = map.point(id);
    const double seen = std::min(1.0, static_cast<double>(p.observations.size()) / 10.0);
    points.push_back({p.position, color_of_score(seen)});
  }
  std::vector<Eigen::Vector3d> centres;
  for (const KeyframeId id : map.keyframe_ids()) {
    centres.push_back(map.keyframe(id).world_from_camera.translation());
  }
  write_ply(path, points, centres);
}

// The poses as they were written while the program ran. The file keeps both names until the final
// trajectory takes the first, so that a kill leaves one of them.
void keep_online(const ResultFolder& folder) {
  namespace fs = std::filesystem;
  const fs::path running = folder.file("trajectory.txt");
  const fs::path kept = folder.file("trajectory_online.txt");
  std::error_code no_links;
  if (!fs::exists(running)) return;  // no pose could be written, which was said
  fs::create_hard_link(running, kept, no_links);
  if (no_links) fs::copy_file(running, kept, fs::copy_options::overwrite_existing);
}

// The trajectories in maps other than that of trajectory.txt.
void write_components(OutputSteps& steps, const ResultFolder& folder, const System& system) {
  const std::vector<ComponentSummary> components = system.components();
  for (const ComponentSummary& c : components) {
    if (c.component == components.front().component || c.frames == 0) continue;
    steps.run([&] {
      write_trajectory(folder.file(fmt::format("trajectory_map{}.txt", c.component)),
                       system.trajectory(c.component));
    });
  }
}

void write_map_results(OutputSteps& steps, const ResultFolder& folder, const System* system) {
  if (system != nullptr) steps.run([&] { write_components(steps, folder, *system); });
  steps.run([&] {
    write_trajectory(folder.file("keyframes.txt"),
                     system ? system->keyframe_trajectory() : Trajectory());
  });
  const Map empty;
  steps.run([&] { write_map(folder.file("map.ply"), system ? system->map() : empty); });
}

}  // namespace

void write_results(OutputSteps& steps, Session& session, OnlineTrajectory& online,
                   const RunRecord& record, const ImageOrigin& sequence) {
  if (session.folder() == nullptr) return;
  ResultFolder& folder = *session.folder();
  const System* system = session.system();
  const bool whole = system == nullptr || session.has_whole_map();
  // Where no pose has done so. What belongs together must not lie among the last results.
  if (!steps.run([&] { folder.begin(); })) return;
  steps.run([&] { online.finish(); });
  steps.run([&] { keep_online(folder); });
  steps.run([&] { write_trajectory(folder.file("trajectory.txt"), record.trajectory); });
  if (whole) {
    write_map_results(steps, folder, system);
  } else {
    warn("keyframes.txt and map.ply: not written, for an error left the map half changed");
  }
  steps.run([&] {
    write_file_atomically(folder.file("trajectory.svg"), draw_result(record.trajectory, sequence));
  });
  steps.run([&] {
    Json summary = summarise(steps, session, record, sequence);
    summary["failed_outputs"] = failed_outputs(steps, record);
    write_file_atomically(folder.file("summary.json"), to_json_text(summary));
  });
}

}  // namespace dxslam::apps
