// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace dxslam {

/// The threads that help with one short task: the processors, up to eight of them.
inline int helpful_threads() {
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 8);
}

/// A thread that does the work; where the system gives no more threads, one that is not joinable.
template <class Work>
std::thread thread_if_possible(const Work& work) {
  try {
    return std::thread(work);
  } catch (const std::system_error&) {
    return {};
  }
}

/// Calls work(i) once for each i below `n`, in no order, by up to `threads` threads, this one among
/// them, and waits for all; by fewer where the system gives no more threads. The first exception
/// comes out after all threads have ended.
template <class Work>
void in_parallel(std::size_t n, int threads, const Work& work) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr error;
  const auto take_turns = [&] {
    try {
      for (std::size_t i = next++; i < n; i = next++) work(i);
    } catch (...) {
      next = n;
      const std::lock_guard<std::mutex> lock(mutex);
      if (!error) error = std::current_exception();
    }
  };
  std::vector<std::thread> helpers;
  const std::size_t wanted = std::min(n, static_cast<std::size_t>(std::max(threads, 1)));
  helpers.reserve(wanted);
  while (helpers.size() + 1 < wanted) {
    std::thread helper = thread_if_possible(take_turns);
    if (!helper.joinable()) break;
    helpers.push_back(std::move(helper));
  }
  take_turns();
  for (std::thread& helper : helpers) helper.join();
  if (error) std::rethrow_exception(error);
}

/// Calls work(begin, end) on `threads` contiguous parts of [0, count), as in_parallel() does. The
/// result may not depend on how the range is cut.
template <class Work>
void parallel_ranges(int count, int threads, const Work& work) {
  const int parts = std::clamp(threads, 1, std::max(count, 1));
  in_parallel(static_cast<std::size_t>(parts), parts, [&](std::size_t i) {
    const int part = static_cast<int>(i);
    work(count * part / parts, count * (part + 1) / parts);
  });
}

}  // namespace dxslam
