// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <nanobind/nanobind.h>

#include <chrono>
#include <future>
#include <thread>
#include <utility>

#include "bindings/shutdown.h"

namespace dxslam::python {

/// Does `work` in a thread of its own, without the GIL, so that Ctrl-C ends the waiting for it. The
/// work then goes on to its end, and what it returns is dropped: it must own all that it uses, and
/// nothing may be amiss if it is done after all. To be called with the GIL.
template <class Work>
auto interruptible(Work work) {
  constexpr std::chrono::milliseconds kSlice{20};
  std::packaged_task<decltype(work())()> task(std::move(work));
  auto result = task.get_future();
  std::thread thread(std::move(task));
  while (true) {
    {
      const nanobind::gil_scoped_release release;
      if (result.wait_for(kSlice) == std::future_status::ready) {
        thread.join();
        break;
      }
    }
    if (PyErr_CheckSignals() != 0) {
      wait_at_exit(std::move(thread));
      throw nanobind::python_error();
    }
  }
  return result.get();
}

}  // namespace dxslam::python
