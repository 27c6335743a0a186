// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/trajectory.h"
#include "features/extractor.h"
#include "optimization/may_go_on.h"
#include "slam/backend.h"
#include "slam/event_stream.h"
#include "slam/fair_mutex.h"
#include "slam/mapping_session.h"
#include "slam/pipeline.h"
#include "slam/right_of_way.h"
#include "slam/snapshot_exchange.h"
#include "slam/system.h"
#include "slam/system_options.h"
#include "slam/tracked_poses.h"
#include "slam/tracking_session.h"

namespace dxslam {

/// What a System is made of, joined. system.h says what each call does, and keeps this out of sight
/// of those who use the library.
class SystemEngine {
 public:
  SystemEngine(const Camera& camera, std::unique_ptr<FeatureExtractor> extractor,
               const SystemOptions& options, System::FrameCallback on_frame);

  void load_map(Map map, std::vector<LoopEdge> closed_loops);
  void set_mapping(bool on) { mapping_ = on; }
  int begin_sequence();

  void process(const RgbdImage& image);
  bool try_process(const RgbdImage& image);
  void finish(const MayGoOn& may_go_on);
  bool has_failed() const { return pipeline_.has_failed(); }

  std::optional<WholeMap> whole_map();
  std::optional<AllPoses> all_poses();
  bool read_map(const System::MapReader& read);
  EventStream& events() { return events_; }

  const FrameLog& frames() const { return poses_.frames(); }
  std::vector<ComponentSummary> components() const { return poses_.components(map()); }
  Trajectory trajectory(std::optional<std::uint32_t> component) const;
  Trajectory keyframe_trajectory(std::optional<std::uint32_t> component) const;
  bool map_is_whole() const { return map_whole_; }
  const Map& map() const { return backend_.map(); }
  const Backend& backend() const { return backend_; }
  CallbackFailures callback_failures() const { return callbacks_.failures(); }
  const FeatureExtractor& extractor() const { return *extractor_; }

 private:
  using Task = Pipeline::Task;
  using Tracked = TrackingSession::Result;

  Pipeline::Steps steps();
  ExtractedFrame extract(const RgbdImage& image);
  Task track(const ExtractedFrame& extracted);
  void begin_recording(int number);
  bool must_be_dropped(const Tracked& tracked);
  void tell(const ExtractedFrame& extracted, const Tracked& tracked, double track_ms);
  Task mapping_of(Tracked tracked);
  void change_map(const Task& task);
  RelocalizationAnswer relocalize(const Frame& frame);
  void end_recording(int number);
  void adjust_map(const MayGoOn& may_go_on);
  void tell_failure();
  std::uint32_t main_component() const;

  Camera camera_;
  SystemOptions options_;
  std::unique_ptr<FeatureExtractor> extractor_;
  const System::FrameCallback on_frame_;
  CallbackGuard callbacks_;
  RightOfWay right_of_way_;  // of extraction and tracking over mapping
  SnapshotExchange snapshots_;
  EventStream events_;
  TrackedPoses poses_;
  Backend backend_;
  MappingSession mapping_session_;
  TrackingSession tracking_session_;
  std::optional<int> recording_;    // the one that is tracked; of the tracking thread
  bool awaits_map_ = false;         // the first keyframe is on its way; of the tracking thread
  bool began_ = false;              // an image was given
  bool may_be_map_ = false;         // one was loaded, or an image was given while mapping
  std::optional<int> next_begins_;  // a recording, of this number
  int recordings_ = 0;              // numbers given
  bool finished_ = false;
  std::atomic<bool> mapping_{true};
  std::atomic<bool> live_{false};

  // Held while the map is changed; others take it to read the map.
  FairMutex map_mutex_;
  bool map_whole_ = true;  // guarded by map_mutex_; false once a change of the map has failed

  Pipeline pipeline_;  // the last: its threads use all above
};

}  // namespace dxslam
