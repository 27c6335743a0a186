// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/online_trajectory.h"

#include <fmt/format.h>

#include <exception>

#include "apps/console.h"
#include "apps/failure.h"
#include "core/error.h"

namespace dxslam::apps {

void OnlineTrajectory::append(const StampedPose& pose) {
  if (folder_ == nullptr) return;
  try {
    waiting_.push_back(pose);
    if (waiting_.size() > kMostWaiting) {
      waiting_.pop_front();
      ++forgotten_;
    }
    write_waiting();
  } catch (const std::exception& e) {
    if (!warned_) warn("{}; the run goes on and tries again", failure_of(e).sentence);
    warned_ = true;
  }
}

void OnlineTrajectory::write_waiting() {
  folder_->begin();
  if (!writer_) writer_.emplace(folder_->file(name_));
  for (; !waiting_.empty(); waiting_.pop_front()) writer_->append(waiting_.front());
}

void OnlineTrajectory::finish() {
  if (folder_ == nullptr) return;
  write_waiting();
  writer_.reset();
  if (forgotten_ == 0) return;
  throw InputError(fmt::format("{}: {} poses are missing, for it could not be written for a while",
                               folder_->file(name_), forgotten_));
}

}  // namespace dxslam::apps
