// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map/map_journal.h"

#include <gtest/gtest.h>

#include <map>

#include "map/map.h"
#include "map/test_map.h"

namespace dxslam {
namespace {

// What a reader knows who was told of all changes.
struct Mirror {
  std::map<KeyframeId, Eigen::Vector3d> keyframes;
  std::map<PointId, Eigen::Vector3d> points;

  void follow(Map& map) {
    const MapChanges changes = map.take_changes();
    for (const KeyframeId id : changes.removed_keyframes) ASSERT_EQ(keyframes.erase(id), 1U);
    for (const PointId id : changes.removed_points) ASSERT_EQ(points.erase(id), 1U);
    for (const KeyframeId id : changes.added_keyframes) {
      ASSERT_TRUE(keyframes.emplace(id, map.keyframe(id).world_from_camera.translation()).second);
    }
    for (const PointId id : changes.added_points) {
      ASSERT_TRUE(points.emplace(id, map.point(id).position).second);
    }
    for (const KeyframeId id : changes.moved_keyframes) {
      keyframes.at(id) = map.keyframe(id).world_from_camera.translation();
    }
    for (const PointId id : changes.moved_points) points.at(id) = map.point(id).position;
    expect_same(map);
  }
  void expect_same(const Map& map) const {
    ASSERT_EQ(keyframes.size(), map.keyframe_count());
    ASSERT_EQ(points.size(), map.point_count());
    for (const auto& [id, centre] : keyframes) {
      EXPECT_EQ(centre, map.keyframe(id).world_from_camera.translation());
    }
    for (const auto& [id, position] : points) EXPECT_EQ(position, map.point(id).position);
  }
};

TEST(MapJournal, TellsAllThatHappensToAMap) {
  PointScene scene(200);
  Map map;
  map.add_camera(scene.camera());
  map.record_changes(true);
  Mirror mirror;
  const auto add = [&](int k, KeyframeId parent) {
    const SE3 pose = PointScene::pose(0.05 * k);
    const FramePtr frame = scene.frame(k, pose, 0.0, 1.0);
    const KeyframeId id = map.add_keyframe(frame, pose, parent);
    for (std::uint32_t i = 0; i < frame->size(); i += 3) {
      map.add_point(Eigen::Vector3d(k, i, 1.0), id, i);
    }
    return id;
  };
  const KeyframeId first = add(0, kNoId);
  const KeyframeId second = add(1, first);
  mirror.follow(map);
  EXPECT_EQ(mirror.keyframes.size(), 2U);

  const std::vector<PointId> ids = map.point_ids();
  map.set_position(ids[3], {9.0, 9.0, 9.0});
  map.remove_point(ids[5]);
  map.merge_points(ids[0], ids.back());
  map.set_pose(second, SE3(Eigen::Quaterniond::Identity(), {1.0, 2.0, 3.0}));
  mirror.follow(map);

  const KeyframeId third = add(2, second);
  map.remove_keyframe(second);  // its points go with it
  mirror.follow(map);
  map.remove_keyframe(add(3, third));  // was never there
  mirror.follow(map);

  const KeyframeId other = add(4, kNoId);
  mirror.follow(map);
  map.join_components(third, other, SE3(Eigen::Quaterniond::Identity(), {5.0, 0.0, 0.0}));
  mirror.follow(map);

  map.record_changes(false);
  add(5, third);
  EXPECT_TRUE(map.take_changes().added_keyframes.empty());
}

}  // namespace
}  // namespace dxslam
