// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <functional>
#include <mutex>
#include <string>

namespace dxslam {

/// What callbacks threw. They should not; it ends nothing, but is not forgotten either.
struct CallbackFailures {
  int count = 0;
  std::string first;  ///< what it said
};

/// Calls what may throw, and counts where it does. Any thread.
class CallbackGuard {
 public:
  void call(const std::function<void()>& callback);
  CallbackFailures failures() const;

 private:
  mutable std::mutex mutex_;
  CallbackFailures failures_;  // guarded by mutex_
};

}  // namespace dxslam
