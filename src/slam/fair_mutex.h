// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <mutex>

namespace dxslam {

/// A mutex for a thread that takes it again and again, e.g. for one piece of work after another:
/// whoever waits gets it before that thread does once more.
class FairMutex {
 public:
  void lock() {
    const std::lock_guard turn(turn_);  // kept while waiting: the one who comes next stands behind
    mutex_.lock();
  }
  void unlock() { mutex_.unlock(); }

 private:
  std::mutex turn_;
  std::mutex mutex_;
};

}  // namespace dxslam
