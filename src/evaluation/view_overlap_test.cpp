// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/view_overlap.h"

#include <gtest/gtest.h>

#include "evaluation/loop_truth_from_poses.h"

namespace dxslam {
namespace {

Camera small_camera() {
  Camera camera;
  camera.width = 320;
  camera.height = 240;
  camera.fx = camera.fy = 320;
  camera.cx = 159.5;
  camera.cy = 119.5;
  return camera;
}

/// Looks along z at a wall z metres from the origin of the world, from (x, 0, 0).
DepthView before_wall(double x, float wall, float reading = 0.0F) {
  const cv::Mat depth(240, 320, CV_32F, cv::Scalar(reading > 0.0F ? reading : wall));
  return {depth, small_camera(), SE3(Eigen::Quaterniond::Identity(), {x, 0.0, 0.0})};
}

TEST(ViewOverlap, IsTheShareOfTheSurfaceThatBothSee) {
  const DepthView first = before_wall(0.0, 2.0F);  // sees 2 m of the wall
  EXPECT_NEAR(first.share_seen_by(before_wall(0.0, 2.0F)), 1.0, 0.01);
  EXPECT_NEAR(first.share_seen_by(before_wall(0.5, 2.0F)), 0.75, 0.08);
  EXPECT_EQ(first.share_seen_by(before_wall(2.2, 2.0F)), 0.0);
}

TEST(ViewOverlap, IsNoneWhereSomethingStandsInBetween) {
  EXPECT_EQ(before_wall(0.0, 2.0F).share_seen_by(before_wall(0.0, 2.0F, 1.0F)), 0.0);
}

TEST(ViewOverlap, IsNoneBehindTheCamera) {
  const cv::Mat depth(240, 320, CV_32F, cv::Scalar(2.0F));
  const DepthView away(depth, small_camera(), SE3(so3_exp({0.0, M_PI, 0.0}), {0.0, 0.0, 0.0}));
  EXPECT_EQ(before_wall(0.0, 2.0F).share_seen_by(away), 0.0);
}

TEST(ViewOverlap, PassesOverMissingReadings) {
  const cv::Mat nothing(240, 320, CV_32F, cv::Scalar(0.0F));
  const DepthView blind(nothing, small_camera(), SE3());
  EXPECT_EQ(before_wall(0.0, 2.0F).share_seen_by(blind), 0.0);
  EXPECT_EQ(blind.share_seen_by(before_wall(0.0, 2.0F)), 0.0);
  cv::Mat half = cv::Mat(240, 320, CV_32F, cv::Scalar(2.0F));
  half.colRange(160, 320).setTo(0.0F);
  EXPECT_NEAR(before_wall(0.0, 2.0F).share_seen_by(DepthView(half, small_camera(), SE3())), 1.0,
              0.01);
}

TEST(ViewOverlap, MakesDifferentPairsUnclear) {
  LoopTruth truth(4);
  truth.set(1, 0, PairTruth::kSame);
  const std::vector<std::optional<DepthView>> views = {
      before_wall(0.0, 2.0F), before_wall(0.1, 2.0F), before_wall(1.5, 2.0F), std::nullopt};
  PoseLoopOptions options;
  options.overlap = 0.1;
  mark_overlapping_views(views, options, truth);
  EXPECT_EQ(truth.at(1, 0), PairTruth::kSame);
  EXPECT_EQ(truth.at(2, 0), PairTruth::kUnclear);
  EXPECT_EQ(truth.at(3, 0), PairTruth::kDifferent);
}

}  // namespace
}  // namespace dxslam
