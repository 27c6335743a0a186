// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map/map_parts.h"

#include <gmock/gmock.h>

#include <functional>

#include "core/error.h"
#include "map/test_map.h"

namespace dxslam {
namespace {

// A map with gaps in its ids: keyframes and points were removed, points merged.
BuiltMap worn_map() {
  BuiltMap built(8);
  built.map.remove_keyframe(3);
  built.map.remove_keyframe(7);
  const std::vector<PointId> ids = built.map.point_ids();
  for (std::size_t i = 10; i + 1 < 60; i += 2) built.map.merge_points(ids[i], ids[i + 1]);
  for (std::size_t i = 70; i < 90; ++i) built.map.remove_point(ids[i]);
  for (const PointId id : built.map.point_ids()) built.map.refresh_point(id);
  return built;
}

TEST(MapParts, MakeTheSameMapAgainWithoutGaps) {
  const BuiltMap built = worn_map();
  const Map map(take_apart(built.map));
  expect_consistent(map);
  const std::vector<KeyframeId> ids = built.map.keyframe_ids();
  ASSERT_EQ(map.keyframe_count(), ids.size());
  ASSERT_EQ(map.point_count(), built.map.point_count());
  EXPECT_EQ(ids[map.last_keyframe()], built.map.last_keyframe());
  for (KeyframeId id = 0; id < ids.size(); ++id) {
    const Keyframe& k = map.keyframe(id);
    const Keyframe& original = built.map.keyframe(ids[id]);
    EXPECT_EQ(k.frame, original.frame);
    EXPECT_EQ(k.world_from_camera.matrix(), original.world_from_camera.matrix());
    EXPECT_EQ(k.component, original.component);
    EXPECT_EQ(k.parent == kNoId ? kNoId : ids[k.parent], original.parent);
    ASSERT_EQ(k.covisibles.size(), original.covisibles.size());
    for (std::size_t i = 0; i < k.covisibles.size(); ++i) {
      EXPECT_EQ(ids[k.covisibles[i].keyframe], original.covisibles[i].keyframe);
      EXPECT_EQ(k.covisibles[i].shared, original.covisibles[i].shared);
    }
  }
  const std::vector<PointId> points = built.map.point_ids();
  for (PointId id = 0; id < points.size(); ++id) {
    const MapPoint& p = map.point(id);
    const MapPoint& original = built.map.point(points[id]);
    EXPECT_EQ(p.position, original.position);
    EXPECT_EQ(p.normal, original.normal);
    EXPECT_EQ(p.descriptor, original.descriptor);
    EXPECT_EQ(p.visible, original.visible);
    EXPECT_EQ(ids[p.created_by], built.map.anchor_of(original.created_by).keyframe);
    EXPECT_EQ(map.descriptor_of(id).data, built.map.descriptor_of(points[id]).data);
  }
}

TEST(MapParts, AMapMadeOfThemCanBeChanged) {
  BuiltMap built = worn_map();
  Map map(take_apart(built.map));
  const KeyframeId added = map.add_keyframe(built.scene.frame(20, PointScene::pose(0.3)),
                                            PointScene::pose(0.3), map.last_keyframe());
  EXPECT_EQ(added, 6U);
  map.add_point({0, 0, 3}, added, 0);
  map.remove_keyframe(2);
  map.remove_point(5);
  expect_consistent(map);
  EXPECT_EQ(map.add_keyframe(map.keyframe(0).frame, SE3(), kNoId), 7U);
  EXPECT_EQ(map.keyframe(7).component, 1U);
}

TEST(MapParts, NumberComponentsAnew) {
  BuiltMap built(2);
  Map& map = built.map;
  for (int i = 0; i < 3; ++i) map.add_keyframe(map.keyframe(0).frame, SE3(), kNoId);
  map.join_components(0, 3, SE3());
  const MapParts parts = take_apart(map);
  const std::vector<std::uint32_t> expected = {0, 0, 1, 0, 2};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(parts.keyframes[i].component, expected[i]);
  }
  EXPECT_EQ(Map(parts).component_count(), 3U);
}

TEST(MapParts, OfAnEmptyMapMakeAnEmptyMap) {
  const Map map{take_apart(Map())};
  EXPECT_EQ(map.keyframe_count(), 0U);
  EXPECT_EQ(map.last_keyframe(), kNoId);
}

TEST(MapParts, ThatDoNotFitEachOtherAreRefused) {
  const BuiltMap built = worn_map();
  const MapParts good = take_apart(built.map);
  const auto expect_refused = [&](const char* text, const std::function<void(MapParts&)>& spoil) {
    MapParts parts = good;
    spoil(parts);
    try {
      const Map map(std::move(parts));
      ADD_FAILURE() << "accepted, expected: " << text;
    } catch (const ContractError& e) {
      EXPECT_THAT(e.what(), testing::HasSubstr(text));
    }
  };
  expect_refused("no frame", [](MapParts& p) { p.keyframes[1].frame = nullptr; });
  expect_refused("has the id", [](MapParts& p) { p.keyframes[1].id = 2; });
  expect_refused("parent 99", [](MapParts& p) { p.keyframes[1].parent = 99; });
  expect_refused("without parent", [](MapParts& p) { p.keyframes[1].parent = kNoId; });
  expect_refused("different components", [](MapParts& p) { p.keyframes[5].component = 1; });
  expect_refused("of component 77", [](MapParts& p) { p.keyframes[5].component = 77; });
  expect_refused("its own ancestor", [](MapParts& p) { p.keyframes[1].parent = 5; });
  expect_refused("its own ancestor", [](MapParts& p) { p.keyframes[2].parent = 2; });
  expect_refused("last keyframe", [](MapParts& p) { p.last_keyframe = 6; });
  expect_refused("not finite", [](MapParts& p) {
    p.keyframes[1].world_from_camera = SE3(Eigen::Quaterniond::Identity(), {0, std::nan(""), 0});
  });
  expect_refused("has the id", [](MapParts& p) { p.points[1].id = 2; });
  expect_refused("not finite", [](MapParts& p) { p.points[1].position.x() = std::nan(""); });
  expect_refused("made by", [](MapParts& p) { p.points[1].created_by = 6; });
  expect_refused("descriptor", [](MapParts& p) { p.points[1].observations.clear(); });
  expect_refused("descriptor", [](MapParts& p) { p.points[1].descriptor = 1000; });
  expect_refused("keyframe 6", [](MapParts& p) { p.points[1].observations.back().keyframe = 6; });
  expect_refused("rising", [](MapParts& p) {
    p.points[1].observations.push_back(p.points[1].observations.back());
  });
  expect_refused("keypoint 9999", [](MapParts& p) { p.points[1].observations[0].keypoint = 9999; });
  expect_refused("same keypoint",
                 [](MapParts& p) { p.points[1].observations[0] = p.points[0].observations[0]; });
  expect_refused("another kind", [](MapParts& p) {
    auto frame = std::make_shared<Frame>(*p.keyframes[2].frame);
    frame->descriptors = cv::Mat(frame->descriptors.rows, 32, CV_8UC1);
    p.keyframes[2].frame = frame;
  });
  expect_refused("as many", [](MapParts& p) {
    auto frame = std::make_shared<Frame>(*p.keyframes[2].frame);
    frame->depths.pop_back();
    p.keyframes[2].frame = frame;
  });
}

}  // namespace
}  // namespace dxslam
