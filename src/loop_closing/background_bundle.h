// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <atomic>
#include <exception>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "core/camera.h"
#include "core/pause.h"
#include "map/map.h"
#include "mapping/local_bundle.h"
#include "optimization/bundle_adjustment.h"

namespace dxslam {

/// What merging an adjusted bundle did to the map.
struct BundleMerge {
  bool merged = false;         ///< false: the adjustment was of no use, the map is as it was
  int adjusted_keyframes = 0;  ///< have the pose that was worked out for them
  int carried_keyframes = 0;   ///< made meanwhile, or hardly seen: moved with their parent
  int adjusted_points = 0;
  int carried_points = 0;  ///< moved with the keyframe that made them
  int outlier_observations = 0;
  int iterations = 0;
  double initial_cost = 0.0;
  double final_cost = 0.0;
};

/// Writes the result of `bundle`, cut out of an earlier state of the map and adjusted since, into
/// the map as it is now. Keyframes and points made meanwhile keep their place relative to their
/// parent and to the keyframe that made them; what was removed or merged away meanwhile is passed
/// over; observations found wrong are unbound where they still stand.
BundleMerge merge_bundle(const LocalBundle& bundle, const BundleReport& report, Map& map);

/// Bundle adjustment of a whole component in a thread of its own. It works on a copy of the
/// numbers, so the map may grow meanwhile; the owner of the map asks now and then whether it is
/// done, and only then the result is merged, by the owner. All calls belong to the owner's thread.
class BackgroundBundle {
 public:
  /// `in_line`: start() does the work itself, for runs that must be repeatable. Each thread calls a
  /// copy of `pause`.
  BackgroundBundle(const BundleOptions& options, bool in_line, Pause pause = {});
  ~BackgroundBundle();  ///< waits for the thread to notice, an iteration at most
  BackgroundBundle(const BackgroundBundle&) = delete;
  BackgroundBundle& operator=(const BackgroundBundle&) = delete;

  /// Copies the component and begins. What was under way is given up.
  void start(const Map& map, std::uint32_t component);
  /// Whether there is a result to come or to merge.
  bool pending() const { return job_ != nullptr; }
  /// Merges the result if it is there; never waits. Nothing while there is none. Rethrows what the
  /// thread threw.
  std::optional<BundleMerge> poll(Map& map);
  /// Waits for the result and merges it. Nothing if none is pending.
  std::optional<BundleMerge> wait(Map& map);
  /// Gives up what is under way. Does not wait: the thread ends by itself within an iteration.
  void cancel();

 private:
  struct Job {
    LocalBundle bundle;
    BundleReport report;
    std::exception_ptr error;
    std::atomic<bool> stop{false};
    std::atomic<bool> done{false};  ///< released after the fields above were written
    std::thread thread;
  };
  void adjust(Job& job) const;
  void bury_dead();

  BundleOptions options_;
  bool in_line_;
  Pause pause_;
  std::unique_ptr<Job> job_;
  std::vector<std::unique_ptr<Job>> cancelled_;  ///< their threads are about to end
};

}  // namespace dxslam
