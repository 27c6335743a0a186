// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/pipeline.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "core/error.h"

namespace dxslam {

Pipeline::Pipeline(const Sizes& sizes, bool threads, Steps steps)
    : steps_(std::move(steps)), threaded_(threads), frames_(sizes.frames), tasks_(sizes.tasks) {
  if (!threaded_) return;
  try {
    threads_.reserve(2);
    threads_.emplace_back([this] { run([this] { run_tracking(); }); });
    threads_.emplace_back([this] { run([this] { run_mapping(); }); });
  } catch (const std::system_error& error) {
    close();
    join();
    throw InputError(fmt::format("no threads for tracking and mapping: {}, expected two more",
                                 error.code().message()));
  }
}

Pipeline::~Pipeline() {
  close();
  join();
}

void Pipeline::give(ExtractedFrame frame) {
  error_.rethrow();
  if (threaded_) {
    frames_.push(std::move(frame));  // or there is an error to throw
  } else {
    run([&] {
      if (const Task task = steps_.track(frame)) steps_.map(task);
    });
  }
  error_.rethrow();
}

void Pipeline::post(Task task, bool at_once) {
  if (!threaded_) return steps_.map(task);
  at_once ? tasks_.push_at_once(std::move(task)) : tasks_.push(std::move(task));
}

void Pipeline::finish() {
  frames_.close();  // each thread closes the queue behind it when its own runs dry
  join();
}

void Pipeline::run(const Task& step) {
  try {
    step();
  } catch (...) {
    error_.keep_current();
    close();
    steps_.fail();
  }
}

void Pipeline::run_tracking() {
  while (const std::optional<ExtractedFrame> frame = frames_.pop()) {
    Task task = steps_.track(*frame);
    if (task && !tasks_.push(std::move(task))) break;
  }
  tasks_.close();
}

void Pipeline::run_mapping() {
  while (const std::optional<Task> task = tasks_.pop()) steps_.map(*task);
}

void Pipeline::close() {
  frames_.close();
  tasks_.close();
  steps_.unblock();
}

void Pipeline::join() {
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

}  // namespace dxslam
