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
  /// Each image before it is processed, in one thread; `max_depth` as the camera has it.
  void offer(const RgbdImage& image, double max_depth);
  /// Each frame when it was tracked, in one thread.
  void note(const TrackedFrame& frame);

  /// When nothing runs any more: nothing if there is a pose, else why not, in words that follow a
  /// colon. `finds_places`: the features have what places in a stored map are found by.
  std::optional<std::string> why_none(const SystemOptions& options, bool in_stored_map,
                                      bool finds_places, bool stopped) const;

 private:
  std::atomic<bool> has_pose_{false};
  std::size_t images_ = 0;
  std::size_t with_depth_ = 0;  // images with a reading that is not too far
  double max_depth_ = 0.0;
  float nearest_ = 0.0F;    // reading; 0 while there is none
  std::size_t frames_ = 0;  // images that tracking has seen
  int keypoints_ = 0;       // most in one frame
  int known_depths_ = 0;    // the same, of those with depth
};

}  // namespace dxslam::apps
