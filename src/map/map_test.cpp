// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map/map.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include "core/error.h"
#include "map/local_map.h"
#include "map/test_map.h"

namespace dxslam {
namespace {

TEST(Map, KeepsObservationsAndCovisibilityConsistent) {
  BuiltMap built(8);
  Map& map = built.map;
  expect_consistent(map);
  EXPECT_GT(map.keyframe(0).covisibles.size(), 2U);
  map.remove_keyframe(3);
  expect_consistent(map);
  const std::vector<PointId> ids = map.point_ids();
  map.remove_point(ids[5]);
  expect_consistent(map);
  for (std::size_t i = 10; i + 1 < 60; i += 2) map.merge_points(ids[i], ids[i + 1]);
  expect_consistent(map);
  EXPECT_FALSE(map.has_point(ids[10]));
  EXPECT_EQ(map.keyframe_count(), 7U);
}

TEST(Map, MergingMovesOnlyObservationsThatAreFree) {
  BuiltMap built(3);
  const std::vector<PointId> ids = built.map.point_ids();
  const std::size_t before = built.map.point(ids[1]).observations.size();
  built.map.merge_points(ids[0], ids[1]);  // both are seen by keyframe 0
  EXPECT_EQ(built.map.point(ids[1]).observations.size(), before);
  EXPECT_FALSE(built.map.has_point(ids[0]));
  expect_consistent(built.map);
}

TEST(Map, RefusesTakenKeypointsAndUnknownIds) {
  BuiltMap built(2);
  Map& map = built.map;
  const std::vector<PointId> ids = map.point_ids();
  const PointObservation seen = map.point(ids[0]).observations[0];
  EXPECT_FALSE(map.add_observation(ids[1], seen.keyframe, seen.keypoint));
  EXPECT_THROW(map.keyframe(99), ContractError);
  EXPECT_THROW(map.point(999999), ContractError);
  EXPECT_THROW(map.remove_keyframe(0), ContractError);
  EXPECT_THROW(map.add_point(Eigen::Vector3d::Zero(), seen.keyframe, seen.keypoint), ContractError);
}

TEST(Map, ARemovedKeyframeHangsOnItsNearestLivingAncestor) {
  BuiltMap built(5);
  Map& map = built.map;
  const SE3 before = map.keyframe(3).world_from_camera;
  map.remove_keyframe(3);
  map.remove_keyframe(2);
  const Map::Anchor anchor = map.anchor_of(3);
  EXPECT_EQ(anchor.keyframe, 1U);
  const SE3 now = map.keyframe(1).world_from_camera * anchor.anchor_from_camera;
  EXPECT_LT(translation_distance(now, before), 1e-12);
  EXPECT_LT(rotation_angle(now, before), 1e-9);
  EXPECT_EQ(map.keyframe(4).parent, 1U);
}

TEST(Map, BestCovisiblesFallBySharedPoints) {
  BuiltMap built(8);
  const std::vector<Covisible> best = built.map.best_covisibles(4, 3, 1);
  ASSERT_EQ(best.size(), 3U);
  EXPECT_GE(best[0].shared, best[1].shared);
  EXPECT_TRUE(best[0].keyframe == 3 || best[0].keyframe == 5);
  EXPECT_TRUE(built.map.best_covisibles(4, 3, 1000000).empty());
}

// As mapping does for hours in one place: most of what is made is removed again soon.
TEST(Map, KeepsTheMemoryOfWhatLivesNotOfWhatEverWas) {
  PointScene scene(400);
  const FramePtr frame = scene.frame(0, SE3(), 0.0, 1.0);
  Map map;
  const KeyframeId seen_by = map.add_keyframe(frame, SE3(), kNoId);
  const PointId kept = map.add_point(Eigen::Vector3d::UnitZ(), seen_by, 0);
  const auto turn_over = [&](int points) {
    PointId last = kNoId;
    for (int i = 0; i < points; ++i) {
      last = map.add_point(Eigen::Vector3d::UnitZ(), seen_by, 1);
      map.remove_point(last);
    }
    return last;
  };
  const PointId before = turn_over(10000);
  const std::size_t heap = mallinfo2().uordblks + mallinfo2().hblkhd;
  const PointId after = turn_over(1000000);
  EXPECT_EQ(after, before + 1000000);  // no id twice
  EXPECT_LT(mallinfo2().uordblks + mallinfo2().hblkhd, heap + 10000);
  EXPECT_TRUE(map.has_point(kept));
  EXPECT_FALSE(map.has_point(before));
  EXPECT_EQ(map.point_ids(), std::vector<PointId>{kept});
}

// Every tracked frame hangs on a keyframe, and most of these are removed sooner or later.
TEST(Map, KnowsWhereRemovedKeyframesHangInBoundedMemory) {
  PointScene scene(20);
  const FramePtr frame = scene.frame(0, SE3(), 0.0, 1.0);
  Map map;
  const KeyframeId root = map.add_keyframe(frame, PointScene::pose(0.1), kNoId);
  const auto pose = [](int i) { return PointScene::pose(0.001 * (i % 1000)); };
  const auto turn_over = [&](int first, int last) {
    for (int i = first; i < last; ++i) map.remove_keyframe(map.add_keyframe(frame, pose(i), root));
  };
  turn_over(1, 10000);
  const std::size_t heap = mallinfo2().uordblks + mallinfo2().hblkhd;
  turn_over(10000, 60000);
  EXPECT_LT(mallinfo2().uordblks + mallinfo2().hblkhd, heap + 50000);
  const Map moved = std::move(map);
  for (int i = 1; i < 60000; i += 997) {
    const Map::Anchor anchor = moved.anchor_of(static_cast<KeyframeId>(i));
    EXPECT_EQ(anchor.keyframe, root);
    EXPECT_LT(translation_distance(PointScene::pose(0.1) * anchor.anchor_from_camera, pose(i)),
              1e-12);
  }
}

TEST(LocalMap, HoldsThePointsOfCovisibleAndNearbyKeyframes) {
  BuiltMap built(6);
  const LocalMapPtr local = make_local_map(built.map, 5, LocalMapOptions());
  EXPECT_EQ(local->reference, 5U);
  EXPECT_EQ(local->size(), built.map.point_count());
  EXPECT_EQ(local->descriptors.rows, static_cast<int>(local->size()));
  EXPECT_EQ(local->keyframes.size(), 6U);
  for (std::size_t i = 0; i < local->size(); ++i) {
    EXPECT_EQ(local->find(local->ids[i]), static_cast<int>(i));
    EXPECT_EQ(local->positions[i], built.map.point(local->ids[i]).position);
  }
  EXPECT_EQ(local->find(123456), -1);
  ASSERT_NE(local->find_pose(5), nullptr);
  EXPECT_EQ(local->find_pose(77), nullptr);
}

TEST(LocalMap, RespectsItsLimits) {
  BuiltMap built(6);
  LocalMapOptions options;
  options.keyframes = 1;
  options.nearby_keyframes = 0;
  options.max_points = 150;
  const LocalMapPtr local = make_local_map(built.map, 5, options);
  EXPECT_EQ(local->keyframes.size(), 2U);
  EXPECT_LE(local->size(), 150U);
}

TEST(Map, JoinsComponentsWithoutChangingWhatEachSaysOfItself) {
  PointScene scene(400);
  Map map;
  const auto add = [&](int k, KeyframeId parent, const SE3& shift) {
    std::vector<int> source;
    const SE3 pose = PointScene::pose(0.1 * k);
    const FramePtr frame = scene.frame(k, pose, 0.0, 1.0, &source);
    const KeyframeId id = map.add_keyframe(frame, shift * pose, parent);
    for (std::size_t i = 0; i < source.size(); i += 9) {
      map.add_point(shift * scene.points()[static_cast<std::size_t>(source[i])], id,
                    static_cast<std::uint32_t>(i));
    }
    return id;
  };
  const KeyframeId first = add(0, kNoId, SE3());
  const KeyframeId second = add(1, first, SE3());
  Vector6d tangent;
  tangent << 1.0, -2.0, 0.5, 0.3, -0.4, 0.9;
  const SE3 other_world = SE3::exp(tangent);
  const KeyframeId root = add(2, kNoId, other_world);
  const KeyframeId middle = add(3, root, other_world);
  const KeyframeId leaf = add(4, middle, other_world);
  EXPECT_EQ(map.keyframe(second).component, 0U);
  EXPECT_EQ(map.keyframe(leaf).component, 1U);

  map.join_components(second, middle, other_world.inverse());
  expect_consistent(map);
  EXPECT_EQ(map.keyframe(middle).parent, second);
  EXPECT_EQ(map.keyframe(root).parent, middle);
  EXPECT_EQ(map.keyframe(leaf).parent, middle);
  for (const KeyframeId id : map.keyframe_ids()) {
    const Keyframe& k = map.keyframe(id);
    EXPECT_EQ(k.component, 0U);
    EXPECT_LT((k.world_from_camera.inverse() *
               PointScene::pose(0.1 * static_cast<double>(k.frame->index)))
                  .log()
                  .norm(),
              1e-9);
    for (const PointId p : k.points) {
      if (p == kNoId) continue;
      const Eigen::Vector3d in_camera = k.world_from_camera.inverse() * map.point(p).position;
      const auto keypoint = map.point(p).observations.front().keypoint;
      EXPECT_NEAR(in_camera.z(), k.frame->depths[keypoint], 1e-3);
    }
  }
  EXPECT_THROW(map.join_components(first, leaf, SE3()), ContractError);
}

}  // namespace
}  // namespace dxslam
