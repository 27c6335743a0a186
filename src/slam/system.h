// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "core/trajectory.h"
#include "features/extractor.h"
#include "mapping/local_mapper.h"
#include "slam/bounded_queue.h"
#include "slam/stage_times.h"
#include "slam/system_options.h"
#include "tracking/tracker.h"

namespace dxslam {

/// Counts over everything mapping did.
struct MappingTotals {
  int keyframes = 0;
  int new_points = 0;
  int triangulated_points = 0;
  int fused_points = 0;
  int culled_points = 0;
  int culled_keyframes = 0;
  int dropped_requests = 0;  ///< keyframes given up since mapping was busy (real time only)
};

/// The whole system (paper, Fig. 1): feature extraction, tracking and local mapping, each in its
/// own thread, joined by bounded queues. In deterministic mode the same steps run one after another
/// in the caller's thread, and equal input gives equal output to the bit.
///
/// process(), try_process() and finish() belong to one thread; on_frame is called by the tracking
/// thread (in deterministic mode by the caller's). Exceptions of the inner threads come out of the
/// next call.
class System {
 public:
  using FrameCallback = std::function<void(const TrackedFrame&)>;

  /// Takes the extractor. Throws InputError for options out of range.
  System(const Camera& camera, std::unique_ptr<FeatureExtractor> extractor,
         const SystemOptions& options, FrameCallback on_frame = nullptr);
  ~System();
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  /// Takes the next image in time order; waits while the queue is full.
  void process(const RgbdImage& image);
  /// The same for live input: returns false, dropping the image, instead of waiting; mapping never
  /// holds up tracking.
  bool try_process(const RgbdImage& image);
  /// Waits until all is done, adjusts the whole map if so configured, and stops the threads. Only
  /// then may the results below be read. Further calls do nothing.
  void finish();

  /// Every frame given, in order.
  const std::vector<TrackedFrame>& frames() const { return frames_; }
  /// Poses of the tracked frames as the final map has them.
  Trajectory trajectory() const;
  /// Poses of the keyframes.
  Trajectory keyframe_trajectory() const;
  const Map& map() const { return mapper_.map(); }
  const MappingTotals& mapping_totals() const { return totals_; }
  const StageTimes& times() const { return times_; }
  const FeatureExtractor& extractor() const { return *extractor_; }

 private:
  struct Extracted {
    FramePtr frame;
    double ms = 0.0;  // what extraction took
  };
  Extracted extract(const RgbdImage& image);
  std::optional<KeyframeRequest> track(const Extracted& extracted);
  void map_keyframe(const KeyframeRequest& request);
  void publish_local_map();
  LocalMapPtr newest_local_map();

  void run_extraction();
  void run_tracking();
  void run_mapping();
  void guard(void (System::*body)());
  void close_queues();
  void rethrow();

  Camera camera_;
  SystemOptions options_;
  std::unique_ptr<FeatureExtractor> extractor_;
  FrameCallback on_frame_;
  Tracker tracker_;
  LocalMapper mapper_;
  std::vector<TrackedFrame> frames_;
  MappingTotals totals_;
  StageTimes times_;

  BoundedQueue<RgbdImage> images_;
  BoundedQueue<Extracted> extracted_;
  BoundedQueue<KeyframeRequest> requests_;
  std::mutex local_map_mutex_;
  std::condition_variable local_map_changed_;
  LocalMapPtr published_;  // guarded by local_map_mutex_
  bool stopped_ = false;   // guarded by local_map_mutex_
  std::atomic<bool> live_{false};
  std::mutex error_mutex_;
  std::exception_ptr error_;  // guarded by error_mutex_
  std::vector<std::thread> threads_;
  bool finished_ = false;
};

}  // namespace dxslam
