// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/trajectory.h"
#include "features/extractor.h"
#include "optimization/may_go_on.h"
#include "slam/backend.h"
#include "slam/bounded_queue.h"
#include "slam/event_stream.h"
#include "slam/first_error.h"
#include "slam/mapping_session.h"
#include "slam/right_of_way.h"
#include "slam/snapshot_exchange.h"
#include "slam/stage_times.h"
#include "slam/system.h"
#include "slam/system_options.h"
#include "slam/tracked_poses.h"
#include "slam/tracking_session.h"

namespace dxslam {

/// What a System is made of: its queues, threads and parts. system.h says what each call does, and
/// keeps this out of sight of those who use the library.
class SystemEngine {
 public:
  using FrameCallback = System::FrameCallback;
  using MapCallback = System::MapCallback;

  SystemEngine(const Camera& camera, std::unique_ptr<FeatureExtractor> extractor,
               const SystemOptions& options, FrameCallback on_frame);
  ~SystemEngine();
  SystemEngine(const SystemEngine&) = delete;
  SystemEngine& operator=(const SystemEngine&) = delete;

  void load_map(Map map, std::vector<LoopEdge> closed_loops);
  void set_autosave(int keyframes, MapCallback save);
  void set_mapping(bool on) { mapping_ = on; }
  void begin_sequence() { next_begins_sequence_ = true; }

  void process(const RgbdImage& image);
  bool try_process(const RgbdImage& image);
  void finish(const MayGoOn& may_go_on);
  bool has_failed() const { return error_.there_is_one(); }

  std::optional<WholeMap> whole_map();
  EventStream& events() { return events_; }

  const FrameLog& frames() const { return poses_.frames(); }
  std::vector<ComponentSummary> components() const { return poses_.components(map()); }
  Trajectory trajectory(std::optional<std::uint32_t> component) const;
  Trajectory keyframe_trajectory(std::optional<std::uint32_t> component) const;
  bool map_is_whole() const { return map_whole_; }
  const Map& map() const { return backend_.map(); }
  const Backend& backend() const { return backend_; }
  const std::vector<MapSize>& map_sizes() const { return map_sizes_; }
  MappingTotals mapping_totals() const;
  const StageTimes& times() const { return times_; }
  const CallbackFailures& callback_failures() const { return callback_failures_; }
  const FeatureExtractor& extractor() const { return *extractor_; }

 private:
  struct Extracted {
    FramePtr frame;
    bool begins_recording = false;
    double ms = 0.0;  // what extraction took
  };
  using Task = std::function<void()>;  // for the mapping thread
  using Tracked = TrackingSession::Result;

  Extracted extract(const RgbdImage& image);
  Tracked track(const Extracted& extracted);
  void begin_recording();
  bool must_be_dropped(const Tracked& tracked);
  void tell(const Extracted& extracted, const Tracked& tracked, double track_ms);
  Task mapping_of(Tracked tracked);
  void change_map(const Task& task);
  RelocalizationAnswer relocalize(const Frame& frame);
  void autosave();
  void end_of_map();
  void note_map_size();
  std::uint32_t main_component() const;

  void run_tracking();
  void run_mapping();
  void call(const std::function<void()>& callback);
  void tell_failure();
  void guard(const std::function<void()>& body);
  void close_queues();
  void end_threads();

  Camera camera_;
  SystemOptions options_;
  std::unique_ptr<FeatureExtractor> extractor_;
  FrameCallback on_frame_;
  RightOfWay right_of_way_;  // of extraction and tracking over mapping
  SnapshotExchange snapshots_;
  EventStream events_;
  StageTimes times_;
  TrackedPoses poses_;
  Backend backend_;
  MappingSession mapping_session_;
  TrackingSession tracking_session_;
  std::vector<MapSize> map_sizes_;
  std::int64_t dropped_requests_ = 0;
  int recordings_ = 0;  // begun
  MapCallback autosave_;
  int autosave_keyframes_ = 0;
  bool began_ = false;       // an image was given
  bool may_be_map_ = false;  // one was loaded, or an image was given while mapping
  bool next_begins_sequence_ = false;
  std::atomic<bool> mapping_{true};

  // Held while the map is changed; tracking takes it to relocalize.
  std::mutex map_mutex_;
  bool map_whole_ = true;  // guarded by map_mutex_; false once a change of the map has failed

  BoundedQueue<Extracted> extracted_;
  BoundedQueue<Task> tasks_;
  std::atomic<bool> live_{false};
  FirstError error_;
  std::mutex callback_mutex_;
  CallbackFailures callback_failures_;  // guarded by callback_mutex_
  std::vector<std::thread> threads_;
  bool finished_ = false;
};

}  // namespace dxslam
