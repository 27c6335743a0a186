// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/system.h"

#include <algorithm>

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
  threads_.emplace_back([this] { guard(&System::run_tracking); });
  threads_.emplace_back([this] { guard(&System::run_mapping); });
}

System::~System() {
  close_queues();
  for (std::thread& thread : threads_) thread.join();
}

void System::load_map(Map map, std::vector<LoopEdge> closed_loops) {
  require(!began_, "a map must be loaded before the first image");
  require(map.keyframe_count() > 0, "a map to go on with must not be empty");
  backend_.load(std::move(map), std::move(closed_loops));
  map_loaded_ = true;
  next_begins_sequence_ = true;
}

void System::set_autosave(int keyframes, MapCallback save) {
  require(!began_, "autosave must be set before the first image");
  require(keyframes > 0, "autosave needs a positive number of keyframes");
  autosave_keyframes_ = keyframes;
  autosave_ = std::move(save);
}

void System::process(const RgbdImage& image) {
  require(!finished_, "no image can be processed after finish()");
  if (!mapping_ && !map_loaded_) {
    throw InputError("localization mode has no map, expected one to be loaded");
  }
  began_ = true;
  Extracted extracted = extract(image);
  if (!options_.deterministic) {
    extracted_.push(std::move(extracted));
    rethrow();
    return;
  }
  const std::optional<KeyframeRequest> request = track(extracted);
  if (request) map_keyframe(*request);
}

bool System::try_process(const RgbdImage& image) {
  if (options_.deterministic) {
    process(image);
    return true;
  }
  live_ = true;
  rethrow();
  if (!extracted_.has_room()) return false;
  process(image);
  return true;
}

void System::finish(const MayGoOn& may_go_on) {
  if (finished_) return;
  finished_ = true;
  extracted_.close();  // each thread closes the queue behind it when its own runs dry
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
  rethrow();
  const Stopwatch watch;
  backend_.finish(may_go_on);
  times_.add("full_bundle", watch.ms());
  note_map_size();
}

void System::note_map_size() {
  map_sizes_.push_back({map().keyframe_count(), map().point_count()});
}

System::Extracted System::extract(const RgbdImage& image) {
  const bool begins_sequence = std::exchange(next_begins_sequence_, false);
  const RightOfWay::Claim claim(right_of_way_);
  const Stopwatch watch;
  const Features features = extractor_->extract(image.color, false);
  FramePtr frame = make_frame(image, features, camera_);
  const double ms = watch.ms();
  times_.add("extract", ms);
  return {std::move(frame), begins_sequence, ms};
}

std::optional<KeyframeRequest> System::track(const Extracted& extracted) {
  if (LocalMapPtr local_map = newest_local_map()) tracker_.set_local_map(std::move(local_map));
  const Stopwatch watch;
  std::optional<KeyframeRequest> request;
  const TrackedFrame tracked = track_or_relocalize(extracted, request);
  const double ms = watch.ms();
  times_.add("track", ms);
  times_.add("frame", extracted.ms + ms);
  frames_.append(tracked);
  if (on_frame_) on_frame_(tracked);
  return request;
}

TrackedFrame System::track_or_relocalize(const Extracted& extracted,
                                         std::optional<KeyframeRequest>& request) {
  const FramePtr& frame = extracted.frame;
  if (extracted.begins_sequence) {
    if (options_.deterministic && !frames_.empty()) note_map_size();
    if (!options_.deterministic && !frames_.empty()) tasks_.push([this] { note_map_size(); });
    // What was seen last says nothing about where the new recording begins.
    seeking_ = tracker_.has_local_map() || map_loaded_;
    tracker_.restart();
    newest_local_map();
    lost_frames_ = 0;
    const std::lock_guard lock(map_mutex_);
    backend_.begin_recording();
  }
  TrackedFrame tracked;
  if (seeking_) {
    tracked.index = frame->index;
    tracked.stamp = frame->stamp;
    tracked.state = TrackingState::kLost;
    tracked.keypoints = static_cast<int>(frame->size());
  } else {
    const RightOfWay::Claim claim(right_of_way_);
    tracked = tracker_.track(frame, request);
  }
  if (tracked.state != TrackingState::kLost) {
    lost_frames_ = 0;
    return tracked;
  }
  if (std::optional<TrackedFrame> found = find_place(frame, request)) {
    lost_frames_ = 0;
    seeking_ = false;
    return *found;
  }
  if (says_something(*frame)) ++lost_frames_;
  if (lost_frames_ >= options_.new_map_after && mapping_) {
    tracker_.restart();
    newest_local_map();
    lost_frames_ = 0;
    seeking_ = false;
  }
  return tracked;
}

std::optional<TrackedFrame> System::find_place(const FramePtr& frame,
                                               std::optional<KeyframeRequest>& request) {
  const RelocalizationAnswer answer = relocalize(*frame);
  if (!answer.local_map) return std::nullopt;
  newest_local_map();  // of where tracking was before
  const TrackedFrame tracked = tracker_.resume(
      frame, answer.local_map, answer.report.world_from_camera, answer.report.points, request);
  if (tracked.state != TrackingState::kTracking) return std::nullopt;
  return tracked;
}

// In the thread that waits for it.
RelocalizationAnswer System::relocalize(const Frame& frame) {
  const Stopwatch watch;
  const std::lock_guard lock(map_mutex_);
  if (!map_whole_) return {};
  RelocalizationAnswer answer = backend_.relocalize(frame);
  times_.add("relocalize", watch.ms());
  return answer;
}

// A covered lens or a bare wall is no reason to give up a map.
bool System::says_something(const Frame& frame) const {
  const auto with_depth = std::count_if(frame.depths.begin(), frame.depths.end(),
                                        [](float depth) { return depth > 0.0F; });
  return with_depth >= options_.tracking.min_start_points;
}

void System::map_keyframe(const KeyframeRequest& request) {
  if (!mapping_) {
    publish(backend_.follow(request));
    return;
  }
  const Stopwatch insert_watch;
  publish(backend_.insert(request));
  if (request.reference == kNoId) {
    roots_.push_back({request.frame->index, request.frame->stamp, backend_.report().keyframe});
  }
  times_.add("map_insert", insert_watch.ms());
  const Stopwatch refine_watch;
  publish(backend_.refine());
  times_.add("map_refine", refine_watch.ms());
  const Stopwatch loop_watch;
  if (LocalMapPtr moved = backend_.close_loops()) publish(std::move(moved));
  times_.add("loop_closing", loop_watch.ms());
  count(backend_.report());
  if (autosave_ && totals_.keyframes % autosave_keyframes_ == 0) {
    autosave_(map(), backend_.closed_loops());
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

void System::publish(LocalMapPtr local_map) {
  const std::lock_guard lock(local_map_mutex_);
  published_ = std::move(local_map);
  local_map_changed_.notify_all();
}

LocalMapPtr System::newest_local_map() {
  const std::lock_guard lock(local_map_mutex_);
  return std::exchange(published_, nullptr);
}

void System::run_tracking() {
  while (std::optional<Extracted> extracted = extracted_.pop()) {
    std::optional<KeyframeRequest> request = track(*extracted);
    if (!request) continue;
    const bool first = !tracker_.has_local_map();
    Task task = [this, asked = std::move(*request)] { map_keyframe(asked); };
    if (live_ && !first) {
      if (!tasks_.try_push(std::move(task))) ++totals_.dropped_requests;
      continue;
    }
    if (!tasks_.push(std::move(task))) break;
    if (!first) continue;
    // There is nothing to track against before the first keyframe is in the map.
    std::unique_lock lock(local_map_mutex_);
    local_map_changed_.wait(lock, [&] { return published_ != nullptr || stopped_; });
  }
  tasks_.close();
}

void System::run_mapping() {
  while (const std::optional<Task> task = tasks_.pop()) {
    const std::lock_guard lock(map_mutex_);
    map_whole_ = false;
    (*task)();
    map_whole_ = true;
  }
}

void System::guard(void (System::*body)()) {
  try {
    (this->*body)();
  } catch (...) {
    {
      const std::lock_guard lock(error_mutex_);
      if (!error_) error_ = std::current_exception();
    }
    close_queues();
  }
}

void System::close_queues() {
  extracted_.close();
  tasks_.close();
  const std::lock_guard lock(local_map_mutex_);
  stopped_ = true;
  local_map_changed_.notify_all();
}

void System::rethrow() {
  const std::lock_guard lock(error_mutex_);
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
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
