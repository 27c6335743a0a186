// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/callback_guard.h"

#include <exception>

namespace dxslam {

void CallbackGuard::call(const std::function<void()>& callback) {
  std::string said = "something that is no exception";
  try {
    return callback();
  } catch (const std::exception& error) {
    said = error.what();
  } catch (...) {
  }
  const std::lock_guard lock(mutex_);
  if (failures_.count++ == 0) failures_.first = said;
}

CallbackFailures CallbackGuard::failures() const {
  const std::lock_guard lock(mutex_);
  return failures_;
}

}  // namespace dxslam
