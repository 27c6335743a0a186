// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/online_trajectory.h"

#include "apps/console.h"
#include "core/error.h"

namespace dxslam::apps {

void OnlineTrajectory::append(const StampedPose& pose) {
  if (folder_ == nullptr) return;
  waiting_.push_back(pose);
  try {
    write_waiting();
  } catch (const InputError& e) {
    if (!warned_) warn("{}; the run goes on and tries again", e.what());
    warned_ = true;
  }
}

void OnlineTrajectory::write_waiting() {
  folder_->begin();
  if (!writer_) writer_.emplace(folder_->file(name_));
  std::size_t written = 0;
  try {
    for (; written < waiting_.size(); ++written) writer_->append(waiting_[written]);
  } catch (const InputError&) {
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(written));
    throw;
  }
  waiting_.clear();
}

void OnlineTrajectory::finish() {
  if (folder_ == nullptr) return;
  write_waiting();
  writer_.reset();
}

}  // namespace dxslam::apps
