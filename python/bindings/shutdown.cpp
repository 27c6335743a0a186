// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "bindings/shutdown.h"

#include <nanobind/nanobind.h>

#include <chrono>
#include <map>
#include <utility>
#include <vector>

namespace dxslam::python {
namespace {

namespace nb = nanobind;

// Both are used with the GIL alone.
std::map<const void*, std::function<void()>>& living() {
  static std::map<const void*, std::function<void()>> ends;
  return ends;
}
std::vector<std::thread>& left_behind() {
  static std::vector<std::thread> threads;
  return threads;
}

void end_all() {
  const auto ends = std::exchange(living(), {});
  auto threads = std::exchange(left_behind(), {});
  const nb::gil_scoped_release release;
  for (const auto& [key, end] : ends) end();
  for (std::thread& thread : threads) thread.join();
  // What waited for these returns to Python: a thread that wants the GIL later is killed in C++.
  constexpr int kPatience = 1000;  // milliseconds
  for (int i = 0; i < kPatience && Away::count() > 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace

std::atomic<int>& Away::count() {
  static std::atomic<int> count{0};
  return count;
}

void end_at_exit(const void* key, std::function<void()> end) { living()[key] = std::move(end); }
void forget_at_exit(const void* key) { living().erase(key); }
void wait_at_exit(std::thread thread) { left_behind().push_back(std::move(thread)); }

void end_all_at_exit() {
  nb::module_::import_("atexit").attr("register")(nb::cpp_function(&end_all));
}

}  // namespace dxslam::python
