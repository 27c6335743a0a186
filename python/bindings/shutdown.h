// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <functional>
#include <thread>

namespace dxslam::python {

// Threads of C++ must be gone before the interpreter is: it ends threads that ask for its lock
// later, wherever they are.

/// Has `end`, which ends threads, called when the interpreter exits, without the GIL; until it is
/// taken back by its key. With the GIL.
void end_at_exit(const void* key, std::function<void()> end);
void forget_at_exit(const void* key);
/// Has a thread that nobody waits for any more waited for at exit. With the GIL.
void wait_at_exit(std::thread thread);

/// A release of the GIL, which the exit of the interpreter waits for: for what end_at_exit() ends.
class Away {
 public:
  Away() { ++count(); }
  ~Away() = default;
  Away(const Away&) = delete;
  Away& operator=(const Away&) = delete;

  static std::atomic<int>& count();

 private:
  // Goes after the GIL is back.
  struct Back {
    ~Back() { --count(); }
  };
  Back back_;
  nanobind::gil_scoped_release release_;
};

/// Registers all that with Python's `atexit`.
void end_all_at_exit();

}  // namespace dxslam::python
