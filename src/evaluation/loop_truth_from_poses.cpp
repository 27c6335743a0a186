// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/loop_truth_from_poses.h"

#include <cmath>

#include "core/error.h"

namespace dxslam {
namespace {

PairTruth judge(const StampedPose& a, const StampedPose& b, const PoseLoopOptions& options) {
  if (std::abs(a.stamp - b.stamp) < options.window) return PairTruth::kDifferent;
  const double distance = translation_distance(a.world_from_camera, b.world_from_camera);
  const double angle = rotation_angle(a.world_from_camera, b.world_from_camera) * 180.0 / M_PI;
  if (distance <= options.radius && angle <= options.angle) return PairTruth::kSame;
  const bool near =
      distance <= options.unclear * options.radius && angle <= options.unclear * options.angle;
  return near ? PairTruth::kUnclear : PairTruth::kDifferent;
}

}  // namespace

LoopTruth loop_truth_from_poses(const Trajectory& poses, const std::vector<std::size_t>& frames,
                                std::size_t frame_count, const PoseLoopOptions& options) {
  require(poses.size() == frames.size(), "one frame for each pose");
  LoopTruth truth(frame_count);
  std::vector<const StampedPose*> pose_of(frame_count, nullptr);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    require(frames[i] < frame_count, "a frame beyond the sequence");
    pose_of[frames[i]] = &poses[i];
  }
  for (std::size_t i = 0; i < frame_count; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const bool known = pose_of[i] != nullptr && pose_of[j] != nullptr;
      const PairTruth pair = known ? judge(*pose_of[i], *pose_of[j], options) : PairTruth::kUnclear;
      if (pair != PairTruth::kDifferent) truth.set(i, j, pair);
    }
  }
  return truth;
}

void mark_overlapping_views(const std::vector<std::optional<DepthView>>& views,
                            const PoseLoopOptions& options, LoopTruth& truth) {
  require(views.size() == truth.frames(), "one view for each frame");
  if (options.overlap >= 1.0) return;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!views[i] || !views[j] || truth.at(i, j) != PairTruth::kDifferent) continue;
      if (views_overlap(*views[i], *views[j], options.overlap)) {
        truth.set(i, j, PairTruth::kUnclear);
      }
    }
  }
}

}  // namespace dxslam
