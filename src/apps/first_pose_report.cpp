// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/first_pose_report.h"

#include <fmt/format.h>

#include <algorithm>

namespace dxslam::apps {
namespace {

// 0 where there is no reading.
float nearest_reading(const cv::Mat& depth) {
  float nearest = 0.0F;
  for (int row = 0; row < depth.rows; ++row) {
    const float* line = depth.ptr<float>(row);
    for (const float* metres = line; metres != line + depth.cols; ++metres) {
      if (*metres > 0.0F && (nearest == 0.0F || *metres < nearest)) nearest = *metres;
    }
  }
  return nearest;
}

}  // namespace

void FirstPoseReport::offer(const RgbdImage& image, double max_depth) {
  if (has_pose_) return;
  ++images_;
  max_depth_ = max_depth;
  const float nearest = nearest_reading(image.depth);
  if (nearest == 0.0F) return;
  if (nearest <= static_cast<float>(max_depth)) ++with_depth_;
  if (nearest_ == 0.0F || nearest < nearest_) nearest_ = nearest;
}

void FirstPoseReport::note(const TrackedFrame& frame) {
  if (has_pose_) return;
  ++frames_;
  has_pose_ = frame.state == TrackingState::kTracking;
  keypoints_ = std::max(keypoints_, frame.keypoints);
  known_depths_ = std::max(known_depths_, frame.keypoints_with_depth);
}

std::optional<std::string> FirstPoseReport::why_none(const SystemOptions& options,
                                                     bool in_stored_map, bool finds_places,
                                                     bool stopped) const {
  const int needed = options.tracking.min_start_points;
  if (has_pose_) return std::nullopt;
  if (images_ == 0) return stopped ? "stopped before the first frame" : "no image could be read";
  if (nearest_ == 0.0F) return fmt::format("no depth reading in the first {} images", images_);
  if (with_depth_ == 0) {
    return fmt::format(
        "the nearest depth reading of {} images is {:.3g} m, beyond max_depth of the camera ({:g} "
        "m): is its depth_factor right?",
        images_, nearest_, max_depth_);
  }
  if (frames_ == 0 && !stopped) {
    return fmt::format("all {} images with depth failed before tracking", with_depth_);
  }
  if (in_stored_map && !finds_places) {
    return "no keyframe of the map has a global descriptor, so that no frame can be found in it";
  }
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
