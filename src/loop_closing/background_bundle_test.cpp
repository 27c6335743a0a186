// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "loop_closing/background_bundle.h"

#include <gtest/gtest.h>

#include <thread>

#include "core/test_threads.h"
#include "loop_closing/ring_scene.h"

namespace dxslam {
namespace {

Drift jitter() {
  Drift drift;
  drift.turn_bias = drift.move_bias = 0.0;
  drift.turn_noise = 0.002;
  drift.move_noise = 0.005;
  return drift;
}

class BackgroundBundleTest : public testing::Test {
 protected:
  SE3 relative(KeyframeId a, KeyframeId b) const {
    return walk_.map.keyframe(a).world_from_camera.inverse() *
           walk_.map.keyframe(b).world_from_camera;
  }
  double error(KeyframeId a, KeyframeId b) const {
    return translation_distance(relative(a, b), walk_.truth(a).inverse() * walk_.truth(b));
  }

  RingScene scene_{5.0, 60.0};
  RingWalk walk_{scene_, jitter()};
};

TEST_F(BackgroundBundleTest, AdjustsTheWholeMap) {
  walk_.walk(0.0, 8.0, 0.25);
  const double before = walk_.ate();
  BackgroundBundle bundle({10, 10}, true);
  bundle.start(walk_.map, 0);
  EXPECT_TRUE(bundle.pending());
  const std::optional<BundleMerge> merge = bundle.poll(walk_.map);
  ASSERT_TRUE(merge && merge->merged);
  EXPECT_FALSE(bundle.pending());
  EXPECT_EQ(merge->adjusted_keyframes, 32);
  EXPECT_EQ(merge->carried_keyframes, 0);
  EXPECT_LT(merge->final_cost, merge->initial_cost);
  EXPECT_LT(walk_.ate(), 0.5 * before);
  EXPECT_EQ(walk_.map.keyframe(0).world_from_camera.translation(), Eigen::Vector3d::Zero());
}

TEST_F(BackgroundBundleTest, NeedsNoThread) {
  walk_.walk(0.0, 8.0, 0.25);
  const double before = walk_.ate();
  const NoMoreThreads none;
  BackgroundBundle bundle({10, 10}, false);
  bundle.start(walk_.map, 0);
  ASSERT_TRUE(bundle.wait(walk_.map));
  EXPECT_LT(walk_.ate(), 0.5 * before);
}

TEST_F(BackgroundBundleTest, CarriesWhatWasMadeMeanwhile) {
  const KeyframeId last = walk_.walk(0.0, 8.0, 0.25);
  BackgroundBundle bundle({10, 10}, true);
  bundle.start(walk_.map, 0);
  const KeyframeId first_new = walk_.add(8.25);
  const KeyframeId second_new = walk_.add(8.5);
  const SE3 last_from_first = relative(last, first_new);
  const SE3 first_from_second = relative(first_new, second_new);
  PointId fresh = kNoId;
  for (const PointId p : walk_.map.keyframe(second_new).points) {
    if (walk_.map.point(p).created_by == second_new) fresh = p;
  }
  ASSERT_NE(fresh, kNoId);
  const auto seen = [&] {
    return (walk_.map.keyframe(second_new).world_from_camera.inverse() *
            walk_.map.point(fresh).position)
        .eval();
  };
  const Eigen::Vector3d before = seen();
  const SE3 old_pose = walk_.map.keyframe(second_new).world_from_camera;

  const std::optional<BundleMerge> merge = bundle.poll(walk_.map);
  ASSERT_TRUE(merge && merge->merged);
  EXPECT_EQ(merge->carried_keyframes, 2);
  EXPECT_GT(merge->carried_points, 0);
  EXPECT_GT(translation_distance(old_pose, walk_.map.keyframe(second_new).world_from_camera), 1e-4);
  EXPECT_LT(translation_distance(relative(last, first_new), last_from_first), 1e-9);
  EXPECT_LT(translation_distance(relative(first_new, second_new), first_from_second), 1e-9);
  EXPECT_LT((seen() - before).norm(), 1e-9);
}

TEST_F(BackgroundBundleTest, PassesOverWhatWasRemovedMeanwhile) {
  walk_.walk(0.0, 8.0, 0.25);
  BackgroundBundle bundle({10, 10}, true);
  bundle.start(walk_.map, 0);
  walk_.map.remove_keyframe(10);
  const std::vector<PointId> points = walk_.map.point_ids();
  walk_.map.remove_point(points[5]);
  walk_.map.merge_points(points[6], points[7]);
  const std::size_t count = walk_.map.point_count();
  const std::optional<BundleMerge> merge = bundle.poll(walk_.map);
  ASSERT_TRUE(merge && merge->merged);
  EXPECT_EQ(merge->adjusted_keyframes, 31);
  EXPECT_LE(walk_.map.point_count(), count);
  EXPECT_FALSE(walk_.map.has_keyframe(10));
  EXPECT_FALSE(walk_.map.has_point(points[6]));
}

TEST_F(BackgroundBundleTest, UnbindsWrongObservationsThatStillStand) {
  walk_.walk(0.0, 8.0, 0.25);
  // Two points trade their keypoints in keyframe 12.
  Map& map = walk_.map;
  const PointId a = map.keyframe(12).points[0];
  const PointId b = map.keyframe(12).points[1];
  map.remove_observation(a, 12);
  map.remove_observation(b, 12);
  ASSERT_TRUE(map.add_observation(a, 12, 1));
  ASSERT_TRUE(map.add_observation(b, 12, 0));
  BackgroundBundle bundle({10, 10}, true);
  bundle.start(map, 0);
  const std::optional<BundleMerge> merge = bundle.poll(map);
  ASSERT_TRUE(merge && merge->merged);
  EXPECT_GE(merge->outlier_observations, 2);
  EXPECT_EQ(map.keyframe(12).points[0], kNoId);
  EXPECT_EQ(map.keyframe(12).points[1], kNoId);
}

TEST_F(BackgroundBundleTest, LeavesOtherComponentsAlone) {
  walk_.walk(0.0, 4.0, 0.25);
  walk_.add(6.0, true);
  const KeyframeId other = walk_.walk(6.25, 8.0, 0.25);
  const SE3 pose = walk_.map.keyframe(other).world_from_camera;
  BackgroundBundle bundle({5, 5}, true);
  bundle.start(walk_.map, 0);
  const std::optional<BundleMerge> merge = bundle.poll(walk_.map);
  ASSERT_TRUE(merge && merge->merged);
  EXPECT_EQ(merge->carried_keyframes, 0);
  EXPECT_EQ(walk_.map.keyframe(other).world_from_camera.translation(), pose.translation());
}

TEST_F(BackgroundBundleTest, TheThreadComesToTheSameResult) {
  walk_.walk(0.0, 6.0, 0.25);
  RingScene scene(5.0, 60.0);
  RingWalk twin(scene, jitter());
  twin.walk(0.0, 6.0, 0.25);
  BackgroundBundle inside({5, 5}, true);
  inside.start(twin.map, 0);
  ASSERT_TRUE(inside.poll(twin.map));

  BackgroundBundle outside({5, 5}, false);
  outside.start(walk_.map, 0);
  std::optional<BundleMerge> merge;
  while (!(merge = outside.poll(walk_.map))) std::this_thread::yield();
  EXPECT_TRUE(merge->merged);
  EXPECT_TRUE(MapState(walk_.map) == MapState(twin.map));
}

TEST_F(BackgroundBundleTest, ACancelledAdjustmentChangesNothing) {
  walk_.walk(0.0, scene_.circumference(), 0.1);
  const MapState before(walk_.map);
  BackgroundBundle bundle({1000, 1000}, false);
  bundle.start(walk_.map, 0);
  EXPECT_FALSE(bundle.poll(walk_.map));  // a thousand steps take longer than this line
  bundle.cancel();
  EXPECT_FALSE(bundle.pending());
  EXPECT_FALSE(bundle.poll(walk_.map));
  EXPECT_FALSE(bundle.wait(walk_.map));
  EXPECT_TRUE(MapState(walk_.map) == before);

  // Another may be started at once, and in the middle of one.
  bundle.start(walk_.map, 0);
  bundle.start(walk_.map, 0);
  EXPECT_TRUE(bundle.pending());
}

TEST_F(BackgroundBundleTest, AUselessResultChangesNothing) {
  walk_.walk(0.0, 2.0);
  const LocalBundle bundle = gather_component_bundle(walk_.map, 0);
  const MapState before(walk_.map);
  EXPECT_FALSE(merge_bundle(bundle, BundleReport(), walk_.map).merged);
  EXPECT_TRUE(MapState(walk_.map) == before);
}

}  // namespace
}  // namespace dxslam
