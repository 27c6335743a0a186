// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/system_engine.h"

#include <exception>
#include <mutex>
#include <utility>

#include "core/error.h"
#include "slam/stage_times.h"

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

Pipeline::Sizes sizes_of(const SystemOptions& options) {
  return {static_cast<std::size_t>(options.queued_frames),
          static_cast<std::size_t>(options.queued_keyframes)};
}

}  // namespace

SystemEngine::SystemEngine(const Camera& camera, std::unique_ptr<FeatureExtractor> extractor,
                           const SystemOptions& options, System::FrameCallback on_frame)
    : camera_(prepared(camera)),
      options_(checked(options)),
      extractor_(std::move(extractor)),
      on_frame_(std::move(on_frame)),
      backend_(camera_, *extractor_, options_, GiveWay(right_of_way_)),
      mapping_session_(backend_, snapshots_, events_, poses_),
      tracking_session_(camera_, extractor_->traits(), options_, snapshots_, right_of_way_,
                        [this](const Frame& frame) { return relocalize(frame); }),
      mapping_(options_.mode == "slam"),
      pipeline_(sizes_of(options_), !options_.deterministic, steps()) {
  extractor_->keep_encoder(true);
}

Pipeline::Steps SystemEngine::steps() {
  return {[this](const ExtractedFrame& frame) { return track(frame); },
          [this](const Task& task) { change_map(task); }, [this] { snapshots_.stop(); },
          [this] { tell_failure(); }};
}

void SystemEngine::load_map(Map map, std::vector<LoopEdge> closed_loops) {
  require(!began_, "a map must be loaded before the first image");
  require(map.keyframe_count() > 0, "a map to go on with must not be empty");
  const std::lock_guard lock(map_mutex_);
  backend_.load(std::move(map), std::move(closed_loops));
  may_be_map_ = true;
  tracking_session_.go_on_with_map();
  events_.publish_change(events_.has_readers_of<MapChanged>() ? dxslam::whole_map(this->map())
                                                              : MapChanged());
}

int SystemEngine::begin_sequence() {
  next_begins_ = recordings_;
  return recordings_++;
}

void SystemEngine::process(const RgbdImage& image) {
  pipeline_.rethrow();
  require(!finished_, "no image can be processed after finish()");
  may_be_map_ = may_be_map_ || mapping_;
  if (!may_be_map_) {
    throw InputError("localization mode has no map, expected one to be loaded");
  }
  if (!std::exchange(began_, true) && recordings_ == 0) begin_sequence();
  pipeline_.give(extract(image));
}

bool SystemEngine::try_process(const RgbdImage& image) {
  if (options_.deterministic) {
    process(image);
    return true;
  }
  live_ = true;
  pipeline_.rethrow();
  if (!finished_ && !pipeline_.has_room()) {
    events_.publish(ImageSkipped{image.index, image.stamp, SkipReason::kDropped, ""});
    return false;
  }
  process(image);
  return true;
}

void SystemEngine::finish(const MayGoOn& may_go_on) {
  if (std::exchange(finished_, true)) return pipeline_.rethrow();
  pipeline_.finish();
  if (!has_failed()) pipeline_.run([&] { adjust_map(may_go_on); });
  events_.end();
  pipeline_.rethrow();
}

void SystemEngine::adjust_map(const MayGoOn& may_go_on) {
  const Stopwatch watch;
  backend_.finish(may_go_on, [this](const Task& change) {
    change_map([&] { mapping_session_.correct(change); });
  });
  const double ms = watch.ms();
  if (recording_) change_map([this] { end_recording(*recording_); });
  events_.publish(RunFinished{ms});
}

ExtractedFrame SystemEngine::extract(const RgbdImage& image) {
  const RightOfWay::Claim claim(right_of_way_);
  const Stopwatch watch;
  try {
    const Features features = extractor_->extract(image.color, false);
    FramePtr frame = make_frame(image, features, camera_);
    return {std::move(frame), std::exchange(next_begins_, std::nullopt), watch.ms()};
  } catch (const std::exception& error) {
    events_.publish(
        ImageSkipped{image.index, image.stamp, SkipReason::kNotExtracted, error.what()});
    throw;
  }
}

SystemEngine::Task SystemEngine::track(const ExtractedFrame& extracted) {
  // There is nothing to track against before the first keyframe is in the map.
  if (std::exchange(awaits_map_, false) && !snapshots_.wait()) return {};
  if (extracted.begins_recording) begin_recording(*extracted.begins_recording);
  const Stopwatch watch;
  Tracked tracked = tracking_session_.track_or_relocalize(extracted.frame, mapping_);
  if (must_be_dropped(tracked)) {
    tracking_session_.take_back_request();
    tracked.request.reset();
    tracked.request_dropped = true;
    tracked.frame.is_keyframe = false;
  }
  poses_.append(tracked.frame);
  tell(extracted, tracked, watch.ms());
  if (on_frame_) callbacks_.call([&] { on_frame_(tracked.frame); });
  if (!tracked.request) return {};
  awaits_map_ = !tracking_session_.has_local_map();
  return mapping_of(std::move(tracked));
}

void SystemEngine::tell(const ExtractedFrame& extracted, const Tracked& tracked, double track_ms) {
  if (tracked.lost) events_.publish(*tracked.lost);
  if (tracked.found) events_.publish(*tracked.found);
  if (!events_.has_readers_of<FrameTracked>()) return;
  events_.publish(FrameTracked{tracked.frame, tracking_session_.covariance(), extracted.ms,
                               track_ms, tracked.relocalize_ms, tracked.request_dropped});
}

// Live input does not wait for mapping, but for the first keyframe: there is nothing else to track.
bool SystemEngine::must_be_dropped(const Tracked& tracked) {
  return live_ && tracked.request && tracking_session_.has_local_map() &&
         !pipeline_.mapping_has_room();
}

void SystemEngine::begin_recording(int number) {
  // After the keyframes of the recording before, some of which may still wait for mapping.
  Task task = [this, before = std::exchange(recording_, number)] {
    if (before) end_recording(*before);
    backend_.begin_recording();
  };
  pipeline_.post(std::move(task), live_);  // then mapping never holds up tracking
  // What was seen last says nothing about where the new recording begins.
  backend_.forget_seen();
  tracking_session_.begin_recording();
  events_.publish(RecordingBegun{number});
}

void SystemEngine::end_recording(int number) {
  events_.publish(RecordingEnded{number, map().keyframe_count(), map().point_count()});
}

// In the thread that waits for it.
RelocalizationAnswer SystemEngine::relocalize(const Frame& frame) {
  std::unique_lock lock(map_mutex_, std::defer_lock);
  {
    // Mapping may be giving way to frames, with the map in hand.
    const RightOfWay::Hurry hurry(right_of_way_);
    lock.lock();
  }
  if (!map_whole_) return {};
  return backend_.relocalize(frame);
}

void SystemEngine::change_map(const Task& task) {
  const std::lock_guard lock(map_mutex_);
  map_whole_ = false;
  task();
  map_whole_ = true;
}

SystemEngine::Task SystemEngine::mapping_of(Tracked tracked) {
  return [this, asked = std::move(tracked)] {
    if (!asked.mapping) return mapping_session_.follow(*asked.request, asked.epoch);
    mapping_session_.map_keyframe(*asked.request, asked.epoch);
  };
}

std::optional<WholeMap> SystemEngine::whole_map() {
  const std::lock_guard lock(map_mutex_);
  if (!map_whole_) return std::nullopt;
  return WholeMap{events_.map_version(), mapping_session_.begin_telling()};
}

std::optional<AllPoses> SystemEngine::all_poses() {
  const TrackedPoses::Frames frames = poses_.tracked_so_far();
  const std::lock_guard lock(map_mutex_);
  if (!map_whole_) return std::nullopt;
  return AllPoses{events_.map_version(), TrackedPoses::poses_of(frames, map())};
}

bool SystemEngine::read_map(const System::MapReader& read) {
  const std::lock_guard lock(map_mutex_);
  if (!map_whole_) return false;
  read(map(), backend_.closed_loops());
  return true;
}

void SystemEngine::tell_failure() {
  try {
    pipeline_.rethrow();
  } catch (const std::exception& error) {
    events_.publish(RunFailed{error.what()});
  } catch (...) {
    events_.publish(RunFailed{"something that is no exception"});
  }
  events_.end();
}

Trajectory SystemEngine::trajectory(std::optional<std::uint32_t> component) const {
  if (map().keyframe_count() == 0) return {};
  return poses_.trajectory(map(), component ? *component : main_component());
}

Trajectory SystemEngine::keyframe_trajectory(std::optional<std::uint32_t> component) const {
  if (map().keyframe_count() == 0) return {};
  return keyframe_poses(map(), component ? *component : main_component());
}

std::uint32_t SystemEngine::main_component() const { return components().front().component; }

}  // namespace dxslam
