// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/system_engine.h"

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

SystemEngine::SystemEngine(const Camera& camera, std::unique_ptr<FeatureExtractor> extractor,
                           const SystemOptions& options, FrameCallback on_frame)
    : camera_(prepared(camera)),
      options_(checked(options)),
      extractor_(std::move(extractor)),
      on_frame_(std::move(on_frame)),
      backend_(camera_, *extractor_, options_, GiveWay(right_of_way_)),
      mapping_session_(backend_, snapshots_, events_, times_, poses_),
      tracking_session_(camera_, extractor_->traits(), options_, snapshots_, right_of_way_,
                        [this](const Frame& frame) { return relocalize(frame); }),
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

SystemEngine::~SystemEngine() { end_threads(); }

void SystemEngine::end_threads() {
  close_queues();
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

void SystemEngine::load_map(Map map, std::vector<LoopEdge> closed_loops) {
  require(!began_, "a map must be loaded before the first image");
  require(map.keyframe_count() > 0, "a map to go on with must not be empty");
  backend_.load(std::move(map), std::move(closed_loops));
  may_be_map_ = true;
  tracking_session_.go_on_with_map();
  events_.publish_change(events_.has_readers() ? dxslam::whole_map(this->map()) : MapChanged());
  next_begins_sequence_ = true;
}

void SystemEngine::set_autosave(int keyframes, MapCallback save) {
  require(!began_, "autosave must be set before the first image");
  require(keyframes > 0, "autosave needs a positive number of keyframes");
  autosave_keyframes_ = keyframes;
  autosave_ = std::move(save);
}

void SystemEngine::process(const RgbdImage& image) {
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
      Tracked tracked = track(extracted);
      if (tracked.request) change_map(mapping_of(std::move(tracked)));
    });
  }
  error_.rethrow();
}

bool SystemEngine::try_process(const RgbdImage& image) {
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

void SystemEngine::finish(const MayGoOn& may_go_on) {
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
  end_of_map();
  events_.end();
  error_.rethrow();
}

// Others may still ask for the whole map.
void SystemEngine::end_of_map() {
  const std::lock_guard lock(map_mutex_);
  if (!map_whole_) return;
  mapping_session_.tell_changes(true);
  note_map_size();
}

void SystemEngine::note_map_size() {
  map_sizes_.push_back({map().keyframe_count(), map().point_count()});
}

SystemEngine::Extracted SystemEngine::extract(const RgbdImage& image) {
  const RightOfWay::Claim claim(right_of_way_);
  const Stopwatch watch;
  const Features features = extractor_->extract(image.color, false);
  FramePtr frame = make_frame(image, features, camera_);
  const double ms = watch.ms();
  times_.add("extract", ms);
  return {std::move(frame), std::exchange(next_begins_sequence_, false), ms};
}

SystemEngine::Tracked SystemEngine::track(const Extracted& extracted) {
  if (extracted.begins_recording) begin_recording();
  const Stopwatch watch;
  Tracked tracked = tracking_session_.track_or_relocalize(extracted.frame, mapping_);
  if (must_be_dropped(tracked)) {
    tracking_session_.take_back_request();
    tracked.request.reset();
    tracked.frame.is_keyframe = false;
    ++dropped_requests_;
  }
  const double ms = watch.ms();
  times_.add("track", ms);
  times_.add("frame", extracted.ms + ms);
  poses_.append(tracked.frame);
  tell(extracted, tracked, ms);
  if (on_frame_) call([&] { on_frame_(tracked.frame); });
  return tracked;
}

void SystemEngine::tell(const Extracted& extracted, const Tracked& tracked, double track_ms) {
  if (tracked.lost) events_.publish(*tracked.lost);
  if (tracked.found) events_.publish(*tracked.found);
  events_.publish(FrameTracked{tracked.frame, extracted.ms, track_ms});
}

// Live input does not wait for mapping, but for the first keyframe: there is nothing else to track.
bool SystemEngine::must_be_dropped(const Tracked& tracked) {
  return live_ && tracked.request && tracking_session_.has_local_map() && !tasks_.has_room();
}

void SystemEngine::begin_recording() {
  // After the keyframes of the recording before, some of which may still wait for mapping.
  Task task = [this, first = poses_.frames().empty()] {
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
  tracking_session_.begin_recording();
  events_.publish(RecordingBegun{recordings_++});
}

// In the thread that waits for it.
RelocalizationAnswer SystemEngine::relocalize(const Frame& frame) {
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
    autosave();
  };
}

void SystemEngine::autosave() {
  if (!autosave_ || mapping_session_.totals().keyframes % autosave_keyframes_ != 0) return;
  call([this] { autosave_(map(), backend_.closed_loops()); });
}

std::optional<WholeMap> SystemEngine::whole_map() {
  const std::lock_guard lock(map_mutex_);
  if (!map_whole_) return std::nullopt;
  backend_.record_changes(true);
  mapping_session_.tell_changes(false);
  return WholeMap{events_.map_version(), dxslam::whole_map(map())};
}

MappingTotals SystemEngine::mapping_totals() const {
  MappingTotals totals = mapping_session_.totals();
  totals.dropped_requests = dropped_requests_;
  return totals;
}

void SystemEngine::run_tracking() {
  while (std::optional<Extracted> extracted = extracted_.pop()) {
    Tracked tracked = track(*extracted);
    if (!tracked.request) continue;
    const bool first = !tracking_session_.has_local_map();
    if (!tasks_.push(mapping_of(std::move(tracked)))) break;
    // There is nothing to track against before the first keyframe is in the map.
    if (first && !snapshots_.wait()) break;
  }
  tasks_.close();
}

void SystemEngine::run_mapping() {
  while (const std::optional<Task> task = tasks_.pop()) change_map(*task);
}

void SystemEngine::call(const std::function<void()>& callback) {
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

void SystemEngine::tell_failure() {
  try {
    error_.rethrow();
  } catch (const std::exception& error) {
    events_.publish(RunFailed{error.what()});
  } catch (...) {
    events_.publish(RunFailed{"something that is no exception"});
  }
  events_.end();
}

void SystemEngine::guard(const std::function<void()>& body) {
  try {
    body();
  } catch (...) {
    error_.keep_current();
    close_queues();
    tell_failure();
  }
}

void SystemEngine::close_queues() {
  extracted_.close();
  tasks_.close();
  snapshots_.stop();
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
