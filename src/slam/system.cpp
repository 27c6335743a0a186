// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/system.h"

#include "core/error.h"
#include "core/options.h"

namespace dxslam {

System::System(const Camera& camera, std::unique_ptr<FeatureExtractor> extractor,
               const SystemOptions& options, FrameCallback on_frame)
    : camera_(camera),
      options_((validate_options("", options), options)),
      extractor_(std::move(extractor)),
      on_frame_(std::move(on_frame)),
      tracker_(camera, extractor_->traits(), options.tracking),
      mapper_(camera, extractor_->traits(), options.mapping),
      images_(static_cast<std::size_t>(options.queued_frames)),
      extracted_(static_cast<std::size_t>(options.queued_frames)),
      requests_(static_cast<std::size_t>(options.queued_keyframes)) {
  camera_.validate("calibration");
  if (options_.deterministic) return;
  threads_.emplace_back([this] { guard(&System::run_extraction); });
  threads_.emplace_back([this] { guard(&System::run_tracking); });
  threads_.emplace_back([this] { guard(&System::run_mapping); });
}

System::~System() {
  close_queues();
  for (std::thread& thread : threads_) thread.join();
}

void System::process(const RgbdImage& image) {
  require(!finished_, "no image can be processed after finish()");
  if (!options_.deterministic) {
    images_.push(image);
    rethrow();
    return;
  }
  const std::optional<KeyframeRequest> request = track(extract(image));
  if (request) map_keyframe(*request);
}

bool System::try_process(const RgbdImage& image) {
  require(!finished_, "no image can be processed after finish()");
  if (options_.deterministic) {
    process(image);
    return true;
  }
  live_ = true;
  const bool taken = images_.try_push(image);
  rethrow();
  return taken;
}

void System::finish() {
  if (finished_) return;
  finished_ = true;
  images_.close();  // each thread closes the queue behind it when its own runs dry
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
  rethrow();
  if (options_.final_bundle && map().keyframe_count() > 1) {
    const Stopwatch watch;
    mapper_.adjust_full_bundle(options_.full_bundle);
    times_.add("full_bundle", watch.ms());
  }
}

System::Extracted System::extract(const RgbdImage& image) {
  const Stopwatch watch;
  const Features features = extractor_->extract(image.color, false);
  FramePtr frame = make_frame(image, features, camera_);
  const double ms = watch.ms();
  times_.add("extract", ms);
  return {std::move(frame), ms};
}

std::optional<KeyframeRequest> System::track(const Extracted& extracted) {
  if (LocalMapPtr local_map = newest_local_map()) tracker_.set_local_map(std::move(local_map));
  const Stopwatch watch;
  std::optional<KeyframeRequest> request;
  const TrackedFrame tracked = tracker_.track(extracted.frame, request);
  const double ms = watch.ms();
  times_.add("track", ms);
  times_.add("frame", extracted.ms + ms);
  frames_.push_back(tracked);
  if (on_frame_) on_frame_(tracked);
  return request;
}

void System::map_keyframe(const KeyframeRequest& request) {
  const Stopwatch insert_watch;
  MappingReport report = mapper_.insert(request);
  publish_local_map();
  times_.add("map_insert", insert_watch.ms());
  const Stopwatch refine_watch;
  mapper_.refine(report);
  publish_local_map();
  times_.add("map_refine", refine_watch.ms());
  ++totals_.keyframes;
  totals_.new_points += report.new_points;
  totals_.triangulated_points += report.triangulated_points;
  totals_.fused_points += report.fused_points;
  totals_.culled_points += report.culled_points;
  totals_.culled_keyframes += report.culled_keyframes;
}

void System::publish_local_map() {
  LocalMapPtr local_map = mapper_.local_map();
  const std::lock_guard lock(local_map_mutex_);
  published_ = std::move(local_map);
  local_map_changed_.notify_all();
}

LocalMapPtr System::newest_local_map() {
  const std::lock_guard lock(local_map_mutex_);
  return std::exchange(published_, nullptr);
}

void System::run_extraction() {
  while (std::optional<RgbdImage> image = images_.pop()) {
    if (!extracted_.push(extract(*image))) break;
  }
  extracted_.close();
}

void System::run_tracking() {
  while (std::optional<Extracted> extracted = extracted_.pop()) {
    const bool first = !tracker_.has_local_map();
    std::optional<KeyframeRequest> request = track(*extracted);
    if (!request) continue;
    if (live_ && !first) {
      if (!requests_.try_push(std::move(*request))) ++totals_.dropped_requests;
      continue;
    }
    if (!requests_.push(std::move(*request))) break;
    if (!first) continue;
    // There is nothing to track against before the first keyframe is in the map.
    std::unique_lock lock(local_map_mutex_);
    local_map_changed_.wait(lock, [&] { return published_ != nullptr || stopped_; });
  }
  requests_.close();
}

void System::run_mapping() {
  while (std::optional<KeyframeRequest> request = requests_.pop()) map_keyframe(*request);
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
  images_.close();
  extracted_.close();
  requests_.close();
  const std::lock_guard lock(local_map_mutex_);
  stopped_ = true;
  local_map_changed_.notify_all();
}

void System::rethrow() {
  const std::lock_guard lock(error_mutex_);
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

Trajectory System::trajectory() const {
  Trajectory trajectory;
  for (const TrackedFrame& frame : frames_) {
    if (frame.state != TrackingState::kTracking) continue;
    SE3 pose = frame.world_from_camera;
    if (frame.reference != kNoId) {
      const Map::Anchor anchor = map().anchor_of(frame.reference);
      pose = map().keyframe(anchor.keyframe).world_from_camera * anchor.anchor_from_camera *
             frame.reference_from_camera;
    }
    trajectory.push_back({frame.stamp, pose});
  }
  return trajectory;
}

Trajectory System::keyframe_trajectory() const {
  Trajectory trajectory;
  for (const KeyframeId id : map().keyframe_ids()) {
    const Keyframe& keyframe = map().keyframe(id);
    trajectory.push_back({keyframe.frame->stamp, keyframe.world_from_camera});
  }
  return trajectory;
}

}  // namespace dxslam
