// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <exception>
#include <mutex>

namespace dxslam {

/// What went wrong first in any of several threads. It stays: every later call of rethrow() throws
/// it again. All calls may come from any thread.
class FirstError {
 public:
  /// Keeps the exception that is being handled, unless there is one already.
  void keep_current() {
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = std::current_exception();
  }
  bool there_is_one() const {
    const std::lock_guard lock(mutex_);
    return error_ != nullptr;
  }
  /// Does nothing while there is none.
  void rethrow() const {
    const std::lock_guard lock(mutex_);
    if (error_) std::rethrow_exception(error_);
  }

 private:
  mutable std::mutex mutex_;
  std::exception_ptr error_;  // guarded by mutex_
};

}  // namespace dxslam
