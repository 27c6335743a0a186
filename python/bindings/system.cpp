// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "bindings/system.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <future>
#include <stdexcept>
#include <utility>

#include "bindings/events.h"
#include "bindings/interruptible.h"
#include "bindings/shutdown.h"
#include "core/error.h"
#include "slam/stored_system.h"
#include "slam/system_setup.h"

namespace dxslam::python {

FrameCallback::~FrameCallback() {
  const nb::gil_scoped_acquire gil;
  clear();
}

void FrameCallback::call(const TrackedFrame& frame) const {
  const nb::gil_scoped_acquire gil;
  const nb::object function = function_;
  if (!function.is_valid()) return;
  try {
    function(frame);
  } catch (nb::python_error& error) {
    throw std::runtime_error(error.what());  // it has the GIL no more where it is caught
  }
}

PySystem::PySystem(const Camera& camera, const std::optional<SystemOptions>& options,
                   const std::optional<SharedExtractor>& extractor, nb::object on_frame)
    : camera_(camera), options_(options.value_or(SystemOptions())) {
  if (extractor) options_.features = extractor->name();
  settle_options(options_);
  extractor_ = extractor ? *extractor : load_extractor(options_.features, options_.extractor);
  System::FrameCallback told;
  if (!on_frame.is_none()) {
    callback_ = std::make_shared<FrameCallback>(std::move(on_frame));
    told = [callback = callback_](const TrackedFrame& frame) { callback->call(frame); };
  }
  // It loads the vocabulary.
  system_ = interruptible([camera, features = *extractor_, settled = options_, told] {
    return std::make_shared<System>(camera, std::make_unique<SharedExtractor>(features), settled,
                                    told);
  });
  reader_ = std::make_unique<EventReader>(
      system_->subscribe(Subscription::kUnbounded, RunStatistics::kinds()),
      [this](const Message& message) { statistics_.add(message.event); });
  end_at_exit(this, [this] {
    const std::unique_lock lock(turn_, std::try_to_lock);
    try {
      if (lock.owns_lock()) system_->finish([] { return false; });
    } catch (const std::exception&) {  // it was told before, or nobody is left to be told
    }
  });
}

PySystem::~PySystem() {
  forget_at_exit(this);
  {
    const nb::gil_scoped_release release;
    reader_.reset();
    system_.reset();
  }
  release_arrays();
}

template <class Work>
void PySystem::in_turn(const Work& work) {
  const Away away;
  const std::unique_lock lock(turn_, std::try_to_lock);
  require(lock.owns_lock(), "images of a System must come from one thread at a time");
  work();
}

void PySystem::load_map(MapHandle& map) {
  in_turn([&] {
    thumbnails_ = hand_over(map.copy(), *system_, map.name(), map_header(*extractor_));
    has_map_ = true;
  });
}

void PySystem::begin_sequence() {
  in_turn([this] {
    system_->begin_sequence();
    last_stamp_.reset();
  });
}

void PySystem::set_mapping(bool on) {
  const nb::gil_scoped_release release;
  system_->set_mapping(on);
}

void PySystem::take_stamp(double stamp) {
  if (!std::isfinite(stamp)) {
    throw InputError(fmt::format("the stamp is {}, expected seconds", stamp));
  }
  if (last_stamp_ && stamp <= *last_stamp_) {
    throw InputError(
        fmt::format("the stamp is {} s after one of {} s, expected rising ones, or "
                    "begin_sequence() before another recording",
                    stamp, *last_stamp_));
  }
  last_stamp_ = stamp;
}

bool PySystem::process(RgbdImage image, bool live) {
  require_size(image.color, image.depth, camera_);
  bool taken = true;
  in_turn([&] {
    take_stamp(image.stamp);
    next_index_ = image.index + 1;
    if (live) {
      taken = system_->try_process(image);
    } else {
      system_->process(image);
    }
    image = {};
  });
  release_arrays();
  return taken;
}

bool PySystem::process_arrays(double stamp, const ImageArgument& color,
                              const std::optional<ImageArgument>& depth, bool live) {
  RgbdImage image;
  image.index = next_index_;
  image.stamp = stamp;
  image.color = color_image(color);
  if (depth) image.depth = depth_image(*depth, camera_.depth_factor);
  return process(std::move(image), live);
}

void PySystem::finish(bool adjust) {
  constexpr std::chrono::milliseconds kSlice{20};
  std::atomic<bool> goes_on{adjust};
  auto done = std::async(std::launch::async, [&] {
    const std::unique_lock lock(turn_, std::try_to_lock);
    require(lock.owns_lock(), "images of a System must come from one thread at a time");
    finished_ = true;  // even where it throws, all threads have ended
    try {
      system_->finish([&] { return goes_on.load(); });
    } catch (...) {
      reader_->wait();
      throw;
    }
    reader_->wait();  // all is told
  });
  std::optional<nb::python_error> interrupted;
  while (true) {
    {
      const Away away;
      if (done.wait_for(kSlice) == std::future_status::ready) break;
    }
    if (PyErr_CheckSignals() == 0) continue;
    if (!interrupted) interrupted.emplace();
    PyErr_Clear();
    goes_on = false;
  }
  release_arrays();
  if (interrupted) throw std::move(*interrupted);
  done.get();
}

nb::object PySystem::whole_map() {
  std::optional<WholeMap> whole;
  {
    const nb::gil_scoped_release release;
    whole = system_->whole_map();
  }
  if (!whole) return nb::none();
  return to_event(
      std::make_shared<Message>(Message{0, whole->map_version, Event(std::move(whole->map))}));
}

SubscriptionPtr PySystem::subscribe(std::size_t capacity,
                                    const std::optional<nb::iterable>& kinds) {
  const EventKinds wanted = kinds_of(kinds);
  const nb::gil_scoped_release release;
  return system_->subscribe(capacity, wanted);
}

std::optional<AllPoses> PySystem::all_poses() {
  const nb::gil_scoped_release release;
  return system_->all_poses();
}

const System& PySystem::finished() const {
  require(finished_, "results of a System can be read after finish()");
  return *system_;
}

std::shared_ptr<MapHandle> PySystem::map() const {
  const System& system = finished();
  require(system.map_is_whole(), "a change of the map has failed halfway: it cannot be read");
  return std::make_shared<MapHandle>(
      map_header(*extractor_), std::shared_ptr<const Map>(system_, &system.map()),
      stored_loops(system.map(), system.closed_loops()), thumbnails_, "the map of the System");
}

std::vector<std::string> PySystem::notes() const {
  return feature_notes(options_, *extractor_, has_map_);
}

}  // namespace dxslam::python
