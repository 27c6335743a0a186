// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/trajectory.h"
#include "features/extractor.h"
#include "loop_closing/loop_edge.h"
#include "map/map.h"
#include "optimization/may_go_on.h"
#include "slam/callback_guard.h"
#include "slam/event_stream.h"
#include "slam/frame_log.h"
#include "slam/loop_log.h"
#include "slam/observer.h"
#include "slam/system_options.h"
#include "slam/tracked_poses.h"

namespace dxslam {

class SystemEngine;

/// The map at one moment, for readers of the event stream who were not there from the start.
struct WholeMap {
  std::uint64_t map_version = 0;  ///< changes up to this one are in it
  MapChanged map;                 ///< all of it, as added
};

/// Where the frames so far were, by the map at one moment.
struct AllPoses {
  std::uint64_t map_version = 0;  ///< changes up to this one are in it
  std::vector<FramePose> frames;  ///< all that have a pose, in order
};

/// The whole system, as in figure 1 of the paper: feature extraction in the caller's thread,
/// tracking, and mapping with loop closing and relocalization, in threads of their own, joined by
/// bounded queues. Features are extracted in the caller's thread, so a caller with processors to
/// spare should read its images ahead in a thread of its own. In deterministic mode the same steps
/// run one after another in the caller's thread, and equal input gives equal output to the bit.
///
/// process(), try_process() and finish() belong to one thread. What comes of the images is told by
/// subscribe(), while it happens, and by the results below afterwards.
///
/// What goes wrong in tracking or mapping ends the run (has_failed()): process(), try_process() and
/// finish() throw it, every time from then on. finish() stops the threads all the same, so that the
/// results so far can be read afterwards: the frames always, and the map and what hangs on it
/// (components, trajectories) where map_is_whole(). What extraction throws concerns its image
/// alone: the next one may follow.
class System {
 public:
  using FrameCallback = std::function<void(const TrackedFrame&)>;

  /// Takes the extractor. `on_frame` is called with each frame when it was tracked, by the tracking
  /// thread (in deterministic mode by the caller's), which waits for it: simple where it is quick.
  /// What it throws is caught and counted (callback_failures()). Throws InputError for options out
  /// of range, and where the operating system gives no threads.
  System(const Camera& camera, std::unique_ptr<FeatureExtractor> extractor,
         const SystemOptions& options, FrameCallback on_frame = nullptr);
  ~System();
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  /// Goes on with a map made before: the first frames look for their place in it. Before the first
  /// image only. Throws InputError in localization mode without a map (at the first image).
  void load_map(Map map, std::vector<LoopEdge> closed_loops);
  /// Switches between mapping (true) and localization in the map so far, from the next frame on.
  /// Any thread.
  void set_mapping(bool on);
  /// The next image is of another recording: it may be anywhere in the map. Returns the number by
  /// which messages name that recording. They count from 0, one that begins without this included.
  int begin_sequence();

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
  bool has_failed() const;

  /// What happens inside, from now on (observer.h), or the kinds of it that are asked for; ends
  /// with finish() or an error. A reader that is too slow loses the oldest messages, and nobody
  /// waits for it (event_stream.h says how to lose none). event_reader.h reads in a thread of its
  /// own. Any thread.
  SubscriptionPtr subscribe(std::size_t capacity = 1024, EventKinds kinds = EventKinds::all());
  /// The map as it is now; nothing once a change of it has failed halfway. Waits while the map is
  /// worked on. Any thread.
  std::optional<WholeMap> whole_map();
  /// The poses of all frames tracked so far, as the map has them now: after a loop was closed,
  /// other ones than were told when they were tracked. With the version of the map, which messages
  /// name too. Nothing once a change of the map has failed halfway. Waits while the map is worked
  /// on, and holds up mapping while it works out poses, not while it reads the frames. Any thread.
  std::optional<AllPoses> all_poses();
  /// Calls `read` with the map as it is now, e.g. to save it, in the calling thread. Meanwhile the
  /// map stays as it is: mapping waits, so `read` should copy what it needs and return, and must
  /// call nothing of this system. False, without a call, once a change of the map has failed
  /// halfway. Waits while the map is worked on. Throws what `read` throws. Any thread.
  using MapReader = std::function<void(const Map&, const std::vector<LoopEdge>&)>;
  bool read_map(const MapReader& read);
  /// For those who have something to tell as well: an image that could not be read, that the map
  /// was saved.
  EventStream& events();

  /// Every frame given, in order. The ones that began a map have no reference.
  const FrameLog& frames() const;
  /// All maps there are, the one with most tracked frames first.
  std::vector<ComponentSummary> components() const;
  /// Poses of the frames tracked in one component, as the final map has them; of the first of
  /// components() unless said.
  Trajectory trajectory(std::optional<std::uint32_t> component = std::nullopt) const;
  /// Poses of the keyframes, likewise.
  Trajectory keyframe_trajectory(std::optional<std::uint32_t> component = std::nullopt) const;
  /// False if a change of the map failed halfway: nothing should be read from it.
  bool map_is_whole() const;
  const Map& map() const;
  /// Loops closed so far, those of a loaded map included: to be saved with the map.
  const std::vector<LoopEdge>& closed_loops() const;
  /// Every candidate for a loop, and what became of it.
  const LoopLog& loop_log() const;
  /// How loops are looked for, in a word.
  const std::string& loop_method() const;
  /// What `on_frame` has thrown so far. Any thread.
  CallbackFailures callback_failures() const;
  const FeatureExtractor& extractor() const;

 private:
  std::unique_ptr<SystemEngine> engine_;
};

}  // namespace dxslam
