// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/snapshot_exchange.h"

#include <utility>

#include "core/error.h"

namespace dxslam {

void SnapshotExchange::begin_epoch() {
  const std::lock_guard lock(mutex_);
  ++epoch_;
  published_ = nullptr;
}

SnapshotExchange::Epoch SnapshotExchange::epoch() const {
  const std::lock_guard lock(mutex_);
  return epoch_;
}

bool SnapshotExchange::publish(Epoch epoch, LocalMapPtr local_map) {
  require(local_map != nullptr, "a local map must not be null");
  const std::lock_guard lock(mutex_);
  if (epoch != epoch_) return false;
  published_ = std::move(local_map);
  changed_.notify_all();
  return true;
}

LocalMapPtr SnapshotExchange::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(published_, nullptr);
}

bool SnapshotExchange::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return published_ != nullptr || stopped_; });
  return published_ != nullptr;
}

void SnapshotExchange::stop() {
  const std::lock_guard lock(mutex_);
  stopped_ = true;
  changed_.notify_all();
}

}  // namespace dxslam
