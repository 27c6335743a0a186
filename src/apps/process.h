// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <chrono>
#include <stop_token>

namespace dxslam::apps {

/// The first thing in main, before there is any thread. From then on
/// - descriptors 0 to 2 are open (/dev/null where they were closed), so that no file becomes the
///   console by accident;
/// - a pipe that nobody reads any more and a file beyond the allowed size (ulimit -f) are errors of
///   the write, not the death of the process;
/// - SIGINT, SIGTERM and SIGHUP (unless it was ignored, as below nohup) ask for a stop, all of them
///   however often they come. SIGQUIT (Ctrl-\) and SIGKILL still end the process at once.
///
/// A second after the stop the process ends with kInterrupted, wherever it is, unless something is
/// Unsaved or a file is being written. So commands that keep nothing in memory need not look.
void prepare_process();

bool stop_requested();
std::stop_token stop_token();
/// Returns at `when`, or at the stop.
void sleep_until(std::chrono::steady_clock::time_point when);

/// Lives while there is something in memory that will be saved. Its holder looks at
/// stop_requested() often, and then saves and lets go within 2 s.
class Unsaved {
 public:
  Unsaved();
  ~Unsaved();
  Unsaved(const Unsaved&) = delete;
  Unsaved& operator=(const Unsaved&) = delete;
};

/// A thread that cannot be ended goes on: end_process() then leaves without waiting for it.
void abandon_thread();
/// The last thing in main: says that it was stopped, unless it ended well all the same.
[[nodiscard]] int end_process(int code);

}  // namespace dxslam::apps
