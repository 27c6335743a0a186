// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace dxslam {

/// Calls work(i) once for each i below `n`, in no order, on all processors; up to `few` calls are
/// made in this thread alone. The first exception comes out after all threads have ended.
template <class Work>
void in_parallel(std::size_t n, std::size_t few, const Work& work) {
  constexpr unsigned kMostThreads = 8;
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
  const unsigned processors = std::min(kMostThreads, std::thread::hardware_concurrency());
  for (unsigned i = 1; n > few && i < processors; ++i) helpers.emplace_back(take_turns);
  take_turns();
  for (std::thread& helper : helpers) helper.join();
  if (error) std::rethrow_exception(error);
}

}  // namespace dxslam
