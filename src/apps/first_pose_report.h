// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <atomic>
#include <optional>
#include <string>

#include "core/frame.h"
#include "core/sequence.h"
#include "slam/system_options.h"
#include "tracking/tracking_types.h"

namespace dxslam::apps {

/// Why a run has no pose at all: watches images and frames until there is one.
class FirstPoseReport {
 public:
  /// Each image before it is processed, in one thread.
  void offer(const RgbdImage& image);
  /// Each frame when it was tracked, in one thread.
  void note(const TrackedFrame& frame);

  bool has_pose() const { return has_pose_; }
  /// When nothing runs any more: nothing if there is a pose, else why not, in words that follow a
  /// colon.
  std::optional<std::string> why_none(const SystemOptions& options, bool in_stored_map,
                                      bool stopped) const;

 private:
  std::atomic<bool> has_pose_{false};
  std::size_t images_ = 0;
  std::size_t with_depth_ = 0;  // images with a reading
  int keypoints_ = 0;           // most in one frame
  int known_depths_ = 0;        // the same, of those with depth
};

}  // namespace dxslam::apps
