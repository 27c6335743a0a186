// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
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
#include "slam/system_options.h"
#include "slam/tracked_poses.h"
#include "slam/tracking_session.h"

namespace dxslam {

/// What the callbacks threw. They should not; it ends nothing, but is not forgotten either.
struct CallbackFailures {
  int count = 0;
  std::string first;  ///< what it said
};

/// The map at one moment, for readers of the event stream who were not there from the start.
struct WholeMap {
  std::uint64_t map_version = 0;  ///< changes up to this one are in it
  MapChanged map;                 ///< all of it, as added
};

/// How large the map was when a recording ended.
struct MapSize {
  std::size_t keyframes = 0;
  std::size_t points = 0;
};

/// The whole system (paper, Fig. 1): feature extraction in the caller's thread, tracking, and
/// mapping with loop closing and relocalization, in threads of their own, joined by bounded queues.
/// Features are extracted in the caller's thread, so a caller with processors to spare should read
/// its images ahead in a thread of its own. In deterministic mode the same steps run one after
/// another in the caller's thread, and equal input gives equal output to the bit.
///
/// process(), try_process() and finish() belong to one thread; on_frame is called by the tracking
/// thread (in deterministic mode by the caller's).
///
/// What goes wrong in tracking or mapping ends the run (has_failed()): process(), try_process() and
/// finish() throw it, every time from then on. finish() stops the threads all the same, so that the
/// results so far can be read afterwards: the frames always, and the map and what hangs on it
/// (components, trajectories) where map_is_whole(). What extraction throws concerns its image
/// alone: the next one may follow. What a callback throws is caught and counted
/// (callback_failures()).
class System {
 public:
  using FrameCallback = std::function<void(const TrackedFrame&)>;

  /// Takes the extractor. Throws InputError for options out of range, and where the operating
  /// system gives no threads.
  System(const Camera& camera, std::unique_ptr<FeatureExtractor> extractor,
         const SystemOptions& options, FrameCallback on_frame = nullptr);
  ~System();
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  /// Goes on with a map made before: the first frames look for their place in it. Before the first
  /// image only. Throws InputError in localization mode without a map (at the first image).
  void load_map(Map map, std::vector<LoopEdge> closed_loops);
  /// Calls `save` in the mapping thread after every `keyframes` new ones, whether or not it threw
  /// the time before; the map must not be kept beyond the call. Before the first image only.
  using MapCallback = std::function<void(const Map&, const std::vector<LoopEdge>&)>;
  void set_autosave(int keyframes, MapCallback save);
  /// Switches between mapping (true) and localization in the map so far, from the next frame on.
  /// Any thread.
  void set_mapping(bool on) { mapping_ = on; }
  /// The next image is of another recording: it may be anywhere in the map.
  void begin_sequence() { next_begins_sequence_ = true; }

  /// Takes the next image in time order. Extracts its features in the calling thread, while the one
  /// before is tracked, and waits while tracking is `queued_frames` behind.
  void process(const RgbdImage& image);
  /// The same for live input: returns false, dropping the image, if tracking is that far behind;
  /// mapping never holds up tracking.
  bool try_process(const RgbdImage& image);
  /// Waits until all is done, stops the threads, and adjusts the whole map if so configured and
  /// nothing went wrong. Only then may the results below be read. Further calls do nothing, but
  /// throw what went wrong again. Where `may_go_on` says no, what would adjust the whole map is
  /// given up and the map left as tracking and mapping made it.
  void finish(const MayGoOn& may_go_on = {});
  /// Whether something went wrong in tracking or mapping: no image is taken any more. Any thread.
  bool has_failed() const { return error_.there_is_one(); }

  /// What happens inside, from now on (observer.h); ends with finish() or an error. A reader that
  /// is too slow loses the oldest messages, and nobody waits for it. Any thread.
  SubscriptionPtr subscribe(std::size_t capacity = 1024) { return events_.subscribe(capacity); }
  /// The map as it is now. Waits while the map is worked on. Any thread.
  WholeMap whole_map();
  /// For those who have something to tell as well: that the map was saved.
  EventStream& events() { return events_; }

  /// Every frame given, in order. The ones that began a map have no reference.
  const FrameLog& frames() const { return poses_.frames(); }
  /// All maps there are, the one with most tracked frames first.
  std::vector<ComponentSummary> components() const { return poses_.components(map()); }
  /// Poses of the frames tracked in one component, as the final map has them; of the first of
  /// components() unless said.
  Trajectory trajectory(std::optional<std::uint32_t> component = std::nullopt) const;
  /// Poses of the keyframes, likewise.
  Trajectory keyframe_trajectory(std::optional<std::uint32_t> component = std::nullopt) const;
  /// False if a change of the map failed halfway: nothing should be read from it.
  bool map_is_whole() const { return map_whole_; }
  const Map& map() const { return backend_.map(); }
  const Backend& backend() const { return backend_; }
  /// One per recording (begin_sequence), in order.
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
