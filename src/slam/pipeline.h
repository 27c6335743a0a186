// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <thread>
#include <vector>

#include "core/frame.h"
#include "slam/bounded_queue.h"
#include "slam/first_error.h"

namespace dxslam {

/// A frame on its way from extraction to tracking.
struct ExtractedFrame {
  FramePtr frame;
  std::optional<int> begins_recording;  ///< its number
  double ms = 0.0;                      ///< that extraction took
};

/// The threads of a System: frames pass through tracking, and what tracking asks for through
/// mapping, each in a thread of its own behind a bounded queue. Without threads the same steps run
/// one after another in the caller's. What a step throws ends both, for good.
class Pipeline {
 public:
  using Task = std::function<void()>;
  struct Steps {
    std::function<Task(const ExtractedFrame&)> track;  ///< returns what mapping is to do, or none
    std::function<void(const Task&)> map;
    std::function<void()> unblock;  ///< ends what a step waits for; the queues are closed
    std::function<void()> fail;     ///< called in the thread whose step has thrown
  };
  struct Sizes {
    std::size_t frames = 1;  ///< that wait for tracking, at most
    std::size_t tasks = 1;   ///< that wait for mapping
  };

  /// Throws InputError where the operating system gives no threads. What the steps use must outlive
  /// this.
  Pipeline(const Sizes& sizes, bool threads, Steps steps);
  ~Pipeline();
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  /// Waits for room. Throws what went wrong in any step, now or before.
  void give(ExtractedFrame frame);
  bool has_room() { return frames_.has_room(); }
  /// In the tracking step: a task that goes before what this step returns. `at_once`: it does not
  /// wait for room.
  void post(Task task, bool at_once);
  bool mapping_has_room() { return tasks_.has_room(); }
  /// Waits until all steps are done. Then nothing is taken any more.
  void finish();
  /// A further step, in the caller's thread.
  void run(const Task& step);

  bool has_failed() const { return error_.there_is_one(); }
  void rethrow() const { error_.rethrow(); }

 private:
  void run_tracking();
  void run_mapping();
  void close();
  void join();

  const Steps steps_;
  const bool threaded_;
  BoundedQueue<ExtractedFrame> frames_;
  BoundedQueue<Task> tasks_;
  FirstError error_;
  std::vector<std::thread> threads_;
};

}  // namespace dxslam
