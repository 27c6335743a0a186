// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/system.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "core/error.h"

namespace dxslam {
namespace {

SystemOptions checked(const SystemOptions& options) {
  validate_system_options(options);
  return options;
}

Camera prepared(Camera camera) {
  camera.prepare("calibration");
  return camera;
}

}  // namespace

System::System(const Camera& camera, std::unique_ptr<FeatureExtractor> extractor,
               const SystemOptions& options, FrameCallback on_frame)
    : camera_(prepared(camera)),
      options_(checked(options)),
      extractor_(std::move(extractor)),
      on_frame_(std::move(on_frame)),
      tracker_(camera_, extractor_->traits(), options.tracking),
      backend_(camera_, *extractor_, options_, GiveWay(right_of_way_)),
      extracted_(static_cast<std::size_t>(options.queued_frames)),
      tasks_(static_cast<std::size_t>(options.queued_keyframes)) {
  mapping_ = options_.mode == "slam";
  extractor_->keep_encoder(true);
  if (options_.deterministic) return;
  try {
    threads_.reserve(2);
    threads_.emplace_back([this] { guard([this] { run_tracking(); }); });
    threads_.emplace_back([this] { guard([this] { run_mapping(); }); });
  } catch (const std::system_error& error) {
    end_threads();
    throw InputError(fmt::format("no threads for tracking and mapping: {}, expected two more",
                                 error.code().message()));
  }
}

System::~System() { end_threads(); }

void System::end_threads() {
  close_queues();
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

void System::load_map(Map map, std::vector<LoopEdge> closed_loops) {
  require(!began_, "a map must be loaded before the first image");
  require(map.keyframe_count() > 0, "a map to go on with must not be empty");
  backend_.load(std::move(map), std::move(closed_loops));
  may_be_map_ = map_begun_ = true;
  next_begins_sequence_ = true;
}

void System::set_autosave(int keyframes, MapCallback save) {
  require(!began_, "autosave must be set before the first image");
  require(keyframes > 0, "autosave needs a positive number of keyframes");
  autosave_keyframes_ = keyframes;
  autosave_ = std::move(save);
}

void System::process(const RgbdImage& image) {
  error_.rethrow();
  require(!finished_, "no image can be processed after finish()");
  may_be_map_ = may_be_map_ || mapping_;
  if (!may_be_map_) {
    throw InputError("localization mode has no map, expected one to be loaded");
  }
  began_ = true;
  Extracted extracted = extract(image);
  if (!options_.deterministic) {
    extracted_.push(std::move(extracted));  // or there is an error to throw
  } else {
    guard([&] {
      const Tracked tracked = track(extracted);
      if (tracked.request) change_map([&] { map_keyframe(tracked); });
    });
  }
  error_.rethrow();
}

bool System::try_process(const RgbdImage& image) {
  if (options_.deterministic) {
    process(image);
    return true;
  }
  live_ = true;
  error_.rethrow();
  if (!finished_ && !extracted_.has_room()) return false;
  process(image);
  return true;
}

void System::finish(const MayGoOn& may_go_on) {
  if (std::exchange(finished_, true)) return error_.rethrow();
  extracted_.close();  // each thread closes the queue behind it when its own runs dry
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
  if (!has_failed()) {
    guard([&] {
      const Stopwatch watch;
      backend_.finish(may_go_on, [this](const Task& change) { change_map(change); });
      times_.add("full_bundle", watch.ms());
    });
  }
  if (map_whole_) note_map_size();
  error_.rethrow();
}

void System::note_map_size() {
  map_sizes_.push_back({map().keyframe_count(), map().point_count()});
}

System::Extracted System::extract(const RgbdImage& image) {
  const RightOfWay::Claim claim(right_of_way_);
  const Stopwatch watch;
  const Features features = extractor_->extract(image.color, false);
  FramePtr frame = make_frame(image, features, camera_);
  const double ms = watch.ms();
  times_.add("extract", ms);
  return {std::move(frame), std::exchange(next_begins_sequence_, false), ms};
}

System::Tracked System::track(const Extracted& extracted) {
  if (LocalMapPtr local_map = snapshots_.take()) tracker_.set_local_map(std::move(local_map));
  const Stopwatch watch;
  Tracked tracked;
  tracked.mapping = mapping_;
  TrackedFrame frame = track_or_relocalize(extracted, tracked);
  tracked.epoch = snapshots_.epoch();
  if (must_be_dropped(tracked)) {
    tracker_.take_back_request();
    tracked.request.reset();
    frame.is_keyframe = false;
    ++totals_.dropped_requests;
  }
  const double ms = watch.ms();
  times_.add("track", ms);
  times_.add("frame", extracted.ms + ms);
  frames_.append(frame);
  if (on_frame_) call([&] { on_frame_(frame); });
  return tracked;
}

// Live input does not wait for mapping, but for the first keyframe: there is nothing else to track.
bool System::must_be_dropped(const Tracked& tracked) {
  return live_ && tracked.request && tracker_.has_local_map() && !tasks_.has_room();
}

TrackedFrame System::track_or_relocalize(const Extracted& extracted, Tracked& tracked) {
  const FramePtr& frame = extracted.frame;
  if (extracted.begins_sequence) begin_recording();
  if (!tracker_.has_local_map()) {
    if (!tracked.mapping) seeking_ = true;  // it must not begin a map
    if (tracked.mapping && !map_begun_) seeking_ = false;
  }
  TrackedFrame result = not_found(*frame);
  if (!seeking_) {
    const RightOfWay::Claim claim(right_of_way_);
    result = tracker_.track(frame, tracked.request);
  }
  if (result.state != TrackingState::kLost) {
    map_begun_ = map_begun_ || tracked.request.has_value();
    lost_frames_ = 0;
    return result;
  }
  if (std::optional<TrackedFrame> found = find_place(frame, tracked.request)) {
    lost_frames_ = 0;
    seeking_ = false;
    return *found;
  }
  if (can_begin_map(*frame)) ++lost_frames_;
  if (lost_frames_ >= options_.new_map_after && tracked.mapping) {
    go_on_elsewhere();
    seeking_ = false;
  }
  return result;
}

TrackedFrame System::not_found(const Frame& frame) const {
  TrackedFrame result;
  result.index = frame.index;
  result.stamp = frame.stamp;
  result.state = TrackingState::kLost;
  result.keypoints = static_cast<int>(frame.size());
  return result;
}

void System::begin_recording() {
  // After the keyframes of the recording before, some of which may still wait for mapping.
  Task task = [this, first = frames_.empty()] {
    if (!first) note_map_size();
    backend_.begin_recording();
  };
  if (options_.deterministic) {
    task();
  } else if (live_) {
    tasks_.push_at_once(std::move(task));  // mapping never holds up tracking
  } else {
    tasks_.push(std::move(task));
  }
  // What was seen last says nothing about where the new recording begins.
  backend_.forget_seen();
  seeking_ = map_begun_;
  go_on_elsewhere();
}

void System::go_on_elsewhere() {
  tracker_.restart();
  snapshots_.begin_epoch();
  lost_frames_ = 0;
}

std::optional<TrackedFrame> System::find_place(const FramePtr& frame,
                                               std::optional<KeyframeRequest>& request) {
  const RelocalizationAnswer answer = relocalize(*frame);
  if (!answer.local_map) return std::nullopt;
  const TrackedFrame tracked = tracker_.resume(
      frame, answer.local_map, answer.report.world_from_camera, answer.report.points, request);
  if (tracked.state != TrackingState::kTracking) return std::nullopt;
  snapshots_.begin_epoch();  // what is on its way is of where tracking was before
  return tracked;
}

// In the thread that waits for it.
RelocalizationAnswer System::relocalize(const Frame& frame) {
  const Stopwatch watch;
  std::unique_lock lock(map_mutex_, std::defer_lock);
  {
    // Mapping may be giving way to frames, with the map in hand.
    const RightOfWay::Hurry hurry(right_of_way_);
    lock.lock();
  }
  if (!map_whole_) return {};
  RelocalizationAnswer answer = backend_.relocalize(frame);
  times_.add("relocalize", watch.ms());
  return answer;
}

// A covered lens or a bare wall is no reason to give up a map.
bool System::can_begin_map(const Frame& frame) const {
  const auto with_depth = std::count_if(frame.depths.begin(), frame.depths.end(),
                                        [](float depth) { return depth > 0.0F; });
  return with_depth >= options_.tracking.min_start_points;
}

void System::change_map(const Task& task) {
  const std::lock_guard lock(map_mutex_);
  map_whole_ = false;
  task();
  map_whole_ = true;
}

void System::map_keyframe(const Tracked& tracked) {
  const KeyframeRequest& request = *tracked.request;
  if (!tracked.mapping) {
    snapshots_.publish(tracked.epoch, backend_.follow(request));
    return;
  }
  const Stopwatch insert_watch;
  snapshots_.publish(tracked.epoch, backend_.insert(request));
  if (request.reference == kNoId) {
    roots_.push_back({request.frame->index, request.frame->stamp, backend_.report().keyframe});
  }
  times_.add("map_insert", insert_watch.ms());
  const Stopwatch refine_watch;
  snapshots_.publish(tracked.epoch, backend_.refine());
  times_.add("map_refine", refine_watch.ms());
  const Stopwatch loop_watch;
  if (LocalMapPtr moved = backend_.close_loops()) {
    snapshots_.publish(tracked.epoch, std::move(moved));
  }
  times_.add("loop_closing", loop_watch.ms());
  count(backend_.report());
  if (autosave_ && totals_.keyframes % autosave_keyframes_ == 0) {
    call([this] { autosave_(map(), backend_.closed_loops()); });
  }
}

void System::count(const MappingReport& report) {
  ++totals_.keyframes;
  totals_.new_points += report.new_points;
  totals_.triangulated_points += report.triangulated_points;
  totals_.fused_points += report.fused_points;
  totals_.culled_points += report.culled_points;
  totals_.culled_keyframes += static_cast<int>(report.culled_keyframes.size());
  totals_.bundle_keyframes += report.bundle_keyframes;
  totals_.bundle_observations += report.bundle_observations;
  totals_.outlier_observations += report.outlier_observations;
}

void System::run_tracking() {
  while (std::optional<Extracted> extracted = extracted_.pop()) {
    Tracked tracked = track(*extracted);
    if (!tracked.request) continue;
    const bool first = !tracker_.has_local_map();
    if (!tasks_.push([this, asked = std::move(tracked)] { map_keyframe(asked); })) break;
    // There is nothing to track against before the first keyframe is in the map.
    if (first && !snapshots_.wait()) break;
  }
  tasks_.close();
}

void System::run_mapping() {
  while (const std::optional<Task> task = tasks_.pop()) change_map(*task);
}

void System::call(const std::function<void()>& callback) {
  std::string said = "something that is no exception";
  try {
    return callback();
  } catch (const std::exception& error) {
    said = error.what();
  } catch (...) {
  }
  const std::lock_guard lock(callback_mutex_);
  if (callback_failures_.count++ == 0) callback_failures_.first = said;
}

void System::guard(const std::function<void()>& body) {
  try {
    body();
  } catch (...) {
    error_.keep_current();
    close_queues();
  }
}

void System::close_queues() {
  extracted_.close();
  tasks_.close();
  snapshots_.stop();
}

std::vector<ComponentSummary> System::components() const {
  std::vector<ComponentSummary> all(map().component_count());
  for (std::size_t c = 0; c < all.size(); ++c) all[c].component = static_cast<std::uint32_t>(c);
  for (const KeyframeId id : map().keyframe_ids()) ++all[map().keyframe(id).component].keyframes;
  for (const PointId id : map().point_ids()) {
    const KeyframeId seen_by = map().point(id).observations.front().keyframe;
    ++all[map().keyframe(seen_by).component].points;
  }
  frames_.for_each([&](const TrackedFrame& frame) {
    if (const auto component = component_of(frame)) ++all[*component].frames;
  });
  const auto joined = [](const ComponentSummary& c) { return c.keyframes == 0; };
  all.erase(std::remove_if(all.begin(), all.end(), joined), all.end());
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return a.frames != b.frames ? a.frames > b.frames : a.keyframes > b.keyframes;
  });
  return all;
}

// A frame that began a map was tracked before there was a keyframe to hang on.
KeyframeId System::reference_of(const TrackedFrame& frame) const {
  if (frame.state != TrackingState::kTracking || frame.reference != kNoId) return frame.reference;
  const auto began = std::find_if(roots_.begin(), roots_.end(), [&](const Root& root) {
    return root.index == frame.index && root.stamp == frame.stamp;
  });
  return began == roots_.end() ? kNoId : began->keyframe;
}

std::optional<std::uint32_t> System::component_of(const TrackedFrame& frame) const {
  if (frame.state != TrackingState::kTracking) return std::nullopt;
  const KeyframeId reference = reference_of(frame);
  if (reference == kNoId) return std::nullopt;
  return map().keyframe(map().anchor_of(reference).keyframe).component;
}

Trajectory System::trajectory(std::optional<std::uint32_t> component) const {
  const auto all = components();
  if (all.empty()) return {};
  const std::uint32_t wanted = component.value_or(all.front().component);
  Trajectory trajectory;
  frames_.for_each([&](const TrackedFrame& frame) {
    if (component_of(frame) != wanted) return;
    const Map::Anchor anchor = map().anchor_of(reference_of(frame));
    trajectory.push_back({frame.stamp, map().keyframe(anchor.keyframe).world_from_camera *
                                           anchor.anchor_from_camera *
                                           frame.reference_from_camera});
  });
  return trajectory;
}

Trajectory System::keyframe_trajectory(std::optional<std::uint32_t> component) const {
  const auto all = components();
  if (all.empty()) return {};
  const std::uint32_t wanted = component.value_or(all.front().component);
  Trajectory trajectory;
  for (const KeyframeId id : map().keyframe_ids()) {
    const Keyframe& keyframe = map().keyframe(id);
    if (keyframe.component != wanted) continue;
    trajectory.push_back({keyframe.frame->stamp, keyframe.world_from_camera});
  }
  return trajectory;
}

}  // namespace dxslam
