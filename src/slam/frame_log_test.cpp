// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/frame_log.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <cmath>
#include <filesystem>

#include "core/error.h"

namespace dxslam {
namespace {

TrackedFrame frame(int i) {
  Vector6d motion;
  motion << 0.1 * i, std::sin(i), -0.3, 0.02 * i, std::cos(i), 1.0;
  TrackedFrame f;
  f.index = i;
  f.stamp = 1.3e9 + i / 30.0;
  f.state = i % 7 == 3 ? TrackingState::kLost : TrackingState::kTracking;
  f.world_from_camera = SE3::exp(motion);
  f.component = static_cast<std::uint32_t>(i / 100);
  f.reference = static_cast<KeyframeId>(i / 3);
  f.reference_from_camera = SE3::exp(-motion);
  f.keypoints = 1000 + i;
  f.keypoints_with_depth = 500 + i;
  f.inliers = i;
  f.is_keyframe = i % 3 == 0;
  f.recovered = i % 5 == 0;
  f.rms_pixels = 1.0 / (1 + i);
  return f;
}

void expect_equal(const TrackedFrame& a, const TrackedFrame& b) {
  EXPECT_EQ(a.index, b.index);
  EXPECT_EQ(a.stamp, b.stamp);
  EXPECT_EQ(a.state, b.state);
  EXPECT_EQ(a.world_from_camera.matrix(), b.world_from_camera.matrix());
  EXPECT_EQ(a.component, b.component);
  EXPECT_EQ(a.reference, b.reference);
  EXPECT_EQ(a.reference_from_camera.matrix(), b.reference_from_camera.matrix());
  EXPECT_EQ(a.keypoints, b.keypoints);
  EXPECT_EQ(a.keypoints_with_depth, b.keypoints_with_depth);
  EXPECT_EQ(a.inliers, b.inliers);
  EXPECT_EQ(a.is_keyframe, b.is_keyframe);
  EXPECT_EQ(a.recovered, b.recovered);
  EXPECT_EQ(a.rms_pixels, b.rms_pixels);
}

void expect_all_there(const FrameLog& log, int frames) {
  ASSERT_EQ(log.size(), static_cast<std::size_t>(frames));
  int next = 0;
  log.for_each([&](const TrackedFrame& f) { expect_equal(f, frame(next++)); });
  EXPECT_EQ(next, frames);
  for (int i = 0; i < frames; ++i) expect_equal(log[static_cast<std::size_t>(i)], frame(i));
  EXPECT_THROW(log[log.size()], ContractError);
}

TEST(FrameLog, GivesBackWhatItTookToTheBit) {
  for (const int frames : {0, 1, 7, 8, 16, 17, 100}) {
    FrameLog log(8);
    for (int i = 0; i < frames; ++i) log.append(frame(i));
    expect_all_there(log, frames);
  }
}

TEST(FrameLog, KeepsFramesInMemoryWhereNoFileCanBeMade) {
  FrameLog log(8, "/nowhere/at/all");
  for (int i = 0; i < 100; ++i) log.append(frame(i));
  expect_all_there(log, 100);
}

TEST(FrameLog, LeavesNoFileBehind) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "frame_log_leaves_nothing";
  std::filesystem::create_directories(folder);
  FrameLog log(8, folder.string());
  for (int i = 0; i < 100; ++i) log.append(frame(i));
  EXPECT_TRUE(std::filesystem::is_empty(folder));  // not even while it lives
  expect_all_there(log, 100);
}

TEST(FrameLog, HoldsTwoBlocksInMemoryAtMost) {
  FrameLog log(1024);
  for (int i = 0; i < 3000; ++i) log.append(frame(i));
  const std::size_t heap = mallinfo2().uordblks + mallinfo2().hblkhd;
  for (int i = 3000; i < 100000; ++i) log.append(frame(i));
  EXPECT_LT(mallinfo2().uordblks + mallinfo2().hblkhd, heap + 200000);
  expect_equal(log[50000], frame(50000));
}

}  // namespace
}  // namespace dxslam
