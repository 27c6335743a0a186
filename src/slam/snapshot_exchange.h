// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>

#include "map/local_map.h"

namespace dxslam {

/// The newest local map on its way from mapping to tracking. Now and then tracking goes on
/// somewhere else: in a new map, or where relocalization found it. What mapping makes of keyframes
/// from before would lead it back, into another world even. So every request carries the epoch it
/// was made in, and a local map made for it counts in that epoch only. All calls may come from any
/// thread.
class SnapshotExchange {
 public:
  using Epoch = std::uint64_t;

  /// Tracking goes on somewhere else: drops what is on its way.
  void begin_epoch();
  /// That requests made now belong to.
  Epoch epoch() const;

  /// Puts a local map, not null, in place of the one before. Returns false, dropping it, if it was
  /// made for a request of another epoch.
  bool publish(Epoch epoch, LocalMapPtr local_map);
  /// The newest, once; null if there is none that was not taken.
  LocalMapPtr take();
  /// Waits until there is one to take. Returns false if it was stopped instead.
  bool wait();
  /// Ends all waiting, for good.
  void stop();

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Epoch epoch_ = 0;  // guarded by mutex_, as all below
  LocalMapPtr published_;
  bool stopped_ = false;
};

}  // namespace dxslam
