// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/first_pose_report.h"

#include <fmt/format.h>

#include <algorithm>

namespace dxslam::apps {
namespace {

bool has_reading(const cv::Mat& depth) {
  for (int row = 0; row < depth.rows; ++row) {
    const float* line = depth.ptr<float>(row);
    if (std::any_of(line, line + depth.cols, [](float metres) { return metres > 0.0F; })) {
      return true;
    }
  }
  return false;
}

}  // namespace

void FirstPoseReport::offer(const RgbdImage& image) {
  if (has_pose_) return;
  ++images_;
  if (has_reading(image.depth)) ++with_depth_;
}

void FirstPoseReport::note(const TrackedFrame& frame) {
  if (has_pose_) return;
  has_pose_ = frame.state == TrackingState::kTracking;
  keypoints_ = std::max(keypoints_, frame.keypoints);
  known_depths_ = std::max(known_depths_, frame.keypoints_with_depth);
}

std::optional<std::string> FirstPoseReport::why_none(const SystemOptions& options,
                                                     bool in_stored_map, bool stopped) const {
  const int needed = options.tracking.min_start_points;
  if (has_pose_) return std::nullopt;
  if (images_ == 0) return stopped ? "stopped before the first frame" : "no image could be read";
  if (with_depth_ == 0) return fmt::format("no depth reading in the first {} images", images_);
  if (keypoints_ < needed) {
    return fmt::format("too few keypoints in {} images: at most {} of {} needed", images_,
                       keypoints_, needed);
  }
  if (in_stored_map) return fmt::format("none of {} images was found in the map", images_);
  if (known_depths_ < needed) {
    return fmt::format("too few keypoints with depth in {} images: at most {} of {} needed",
                       images_, known_depths_, needed);
  }
  return stopped ? "stopped before tracking began" : "tracking did not begin";
}

}  // namespace dxslam::apps
