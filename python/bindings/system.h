// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "bindings/extractor.h"
#include "bindings/images.h"
#include "bindings/map.h"
#include "slam/event_reader.h"
#include "slam/run_statistics.h"
#include "slam/system.h"

namespace dxslam::python {

/// A function of Python's that the tracking thread calls.
class FrameCallback {
 public:
  explicit FrameCallback(nb::object function) : function_(std::move(function)) {}
  ~FrameCallback();
  FrameCallback(const FrameCallback&) = delete;
  FrameCallback& operator=(const FrameCallback&) = delete;

  /// Throws std::runtime_error with the text of what Python raised. Without the GIL.
  void call(const TrackedFrame& frame) const;
  /// For the garbage collector.
  nb::handle function() const { return function_; }
  void clear() { function_.reset(); }

 private:
  nb::object function_;
};

/// System for Python: all members are called with the GIL, and release it while they work or wait.
/// Calls of process(), try_process(), begin_sequence() and finish() by two threads at once are
/// refused.
class PySystem {
 public:
  PySystem(const Camera& camera, const std::optional<SystemOptions>& options,
           const std::optional<SharedExtractor>& extractor, nb::object on_frame);
  ~PySystem();
  PySystem(const PySystem&) = delete;
  PySystem& operator=(const PySystem&) = delete;

  void load_map(MapHandle& map);
  void begin_sequence();
  void set_mapping(bool on);
  bool process(RgbdImage image, bool live);
  /// Converts arrays, and counts the images.
  bool process_arrays(double stamp, const ImageArgument& color,
                      const std::optional<ImageArgument>& depth, bool live);
  /// `adjust`: the whole map once more, if so configured.
  void finish(bool adjust);

  SubscriptionPtr subscribe(std::size_t capacity, const std::optional<nb::iterable>& kinds);
  std::optional<AllPoses> all_poses();
  nb::object whole_map();
  std::shared_ptr<MapHandle> map() const;
  /// Throws ContractError before finish().
  const System& finished() const;
  const System& system() const { return *system_; }
  const Camera& camera() const { return camera_; }
  const SystemOptions& options() const { return options_; }
  const SharedExtractor& extractor() const { return *extractor_; }
  std::vector<std::string> notes() const;
  std::map<std::string, StageSummary> times() const { return statistics_.stages(); }
  FrameCallback* callback() { return callback_.get(); }

 private:
  // Works off what `work` does in the turn of the caller, without the GIL.
  template <class Work>
  void in_turn(const Work& work);
  // Throws InputError for a stamp that does not follow the one before.
  void take_stamp(double stamp);

  Camera camera_;
  SystemOptions options_;
  std::optional<SharedExtractor> extractor_;
  std::shared_ptr<FrameCallback> callback_;
  std::shared_ptr<System> system_;
  RunStatistics statistics_;
  std::unique_ptr<EventReader> reader_;  // for these
  std::vector<std::string> thumbnails_;  // of the map that it goes on with
  std::mutex turn_;
  std::int64_t next_index_ = 0;
  std::optional<double> last_stamp_;  // of this recording
  bool has_map_ = false;
  std::atomic<bool> finished_{false};
};

}  // namespace dxslam::python
