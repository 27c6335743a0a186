// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "relocalization/relocalizer.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "relocalization/test_map.h"

namespace dxslam {
namespace {

// Two places, each a component of the map with a world of its own.
class RelocalizerTest : public testing::Test {
 protected:
  RelocalizerTest() : relocalizer_(one_.camera(), one_.traits()) {
    Vector6d motion;
    motion << 5.0, -2.0, 1.0, 0.1, 0.8, -0.2;
    other_world_ = SE3::exp(motion);
    add_scene(one_, 10, 0.0, SE3(), map_);
    add_scene(other_, 10, 1.0, other_world_, map_);
    index_ = index_keyframes(map_);
  }

  FramePtr query(PointScene& scene, const SE3& pose, double place, double depth_share = 0.8) {
    return with_global(scene.frame(100, pose, 0.3, depth_share), global_at(place));
  }

  PointScene one_{2500, 11};
  PointScene other_{2500, 12};
  SE3 other_world_;
  Map map_;
  GlobalIndex index_;
  Relocalizer relocalizer_;
};

TEST_F(RelocalizerTest, IndexesEveryKeyframe) {
  EXPECT_EQ(index_.size(), map_.keyframe_count());
  EXPECT_EQ(index_.dimension(), 3);
}

TEST_F(RelocalizerTest, FindsAFrameBetweenTheKeyframes) {
  const SE3 truth = PointScene::pose(0.43);
  const FramePtr frame = query(one_, truth, 0.086);
  const RelocalizationReport report = relocalizer_.relocalize(map_, index_, *frame);
  ASSERT_TRUE(report.accepted);
  EXPECT_LT(translation_distance(report.world_from_camera, truth), 0.01);
  EXPECT_LT(rotation_angle(report.world_from_camera, truth), 0.003);
  EXPECT_EQ(report.component, 0U);
  EXPECT_EQ(report.groups_tried, 1);
  EXPECT_GT(report.confidence, 0.9);
  EXPECT_GT(report.ratio(), 0.5);
  EXPECT_GT(report.coverage, 0.9);
  ASSERT_TRUE(map_.has_keyframe(report.reference));
  EXPECT_LT(translation_distance(map_.keyframe(report.reference).world_from_camera, truth), 0.5);
  int bound = 0;
  ASSERT_EQ(report.points.size(), frame->size());
  for (const PointId id : report.points) bound += id != kNoId ? 1 : 0;
  EXPECT_EQ(bound, report.inliers);
}

TEST_F(RelocalizerTest, SaysWhichComponentAndUsesItsWorld) {
  const SE3 truth = PointScene::pose(0.6);
  const RelocalizationReport report =
      relocalizer_.relocalize(map_, index_, *query(other_, truth, 1.12));
  ASSERT_TRUE(report.accepted);
  EXPECT_EQ(report.component, 1U);
  EXPECT_LT(translation_distance(report.world_from_camera, other_world_ * truth), 0.01);
}

TEST_F(RelocalizerTest, AMisleadingGlobalDescriptorCostsAGroup) {
  const SE3 truth = PointScene::pose(0.1);
  const RelocalizationReport report =
      relocalizer_.relocalize(map_, index_, *query(one_, truth, 1.02));
  ASSERT_TRUE(report.accepted);
  EXPECT_EQ(report.component, 0U);
  EXPECT_GT(report.groups_tried, 1);
  EXPECT_LT(translation_distance(report.world_from_camera, truth), 0.01);
}

TEST_F(RelocalizerTest, NeedsNoDepth) {
  const SE3 truth = PointScene::pose(0.43);
  const RelocalizationReport report =
      relocalizer_.relocalize(map_, index_, *query(one_, truth, 0.086, 0.0));
  ASSERT_TRUE(report.accepted);
  EXPECT_LT(translation_distance(report.world_from_camera, truth), 0.02);
}

TEST_F(RelocalizerTest, RejectsAnotherPlaceThatLooksAlike) {
  PointScene elsewhere(2500, 99);
  const RelocalizationReport report =
      relocalizer_.relocalize(map_, index_, *query(elsewhere, PointScene::pose(0.3), 0.05));
  EXPECT_FALSE(report.accepted);
  EXPECT_LE(report.groups_tried, relocalizer_.options().max_groups);
}

TEST_F(RelocalizerTest, RejectsAFewPointsInACornerOfTheImage) {
  const FramePtr whole = query(one_, PointScene::pose(0.43), 0.086);
  auto corner = std::make_shared<Frame>();
  corner->global = whole->global;
  for (std::size_t i = 0; i < whole->size(); ++i) {
    if (whole->pixels[i].x() > 60.0F || whole->pixels[i].y() > 200.0F) continue;
    corner->pixels.push_back(whole->pixels[i]);
    corner->depths.push_back(whole->depths[i]);
    corner->scores.push_back(1.0F);
    corner->sigmas.push_back(1.0F);
    corner->descriptors.push_back(whole->descriptors.row(static_cast<int>(i)));
  }
  ASSERT_GE(corner->size(), 30U);
  const RelocalizationReport report = relocalizer_.relocalize(map_, index_, *corner);
  EXPECT_TRUE(report.has_pose);
  EXPECT_LT(report.spread, 0.03);
  EXPECT_FALSE(report.accepted);
}

TEST_F(RelocalizerTest, RejectsAThingThatIsThereTwice) {
  // Another place in which one thing of the first stands, seen from the same side.
  PointScene elsewhere(2500, 99);
  const FramePtr twin = query(one_, PointScene::pose(0.43), 0.086);
  const FramePtr rest = elsewhere.frame(100, PointScene::pose(0.43), 0.3, 0.8);
  const auto on_thing = [](const Eigen::Vector2f& p) {
    return p.x() > 200.0F && p.x() < 400.0F && p.y() > 120.0F && p.y() < 320.0F;
  };
  auto mixed = std::make_shared<Frame>();
  mixed->global = twin->global;
  for (const Frame* from : {twin.get(), rest.get()}) {
    for (std::size_t i = 0; i < from->size(); ++i) {
      if (on_thing(from->pixels[i]) != (from == twin.get())) continue;
      mixed->pixels.push_back(from->pixels[i]);
      mixed->depths.push_back(from->depths[i]);
      mixed->scores.push_back(1.0F);
      mixed->sigmas.push_back(1.0F);
      mixed->descriptors.push_back(from->descriptors.row(static_cast<int>(i)));
    }
  }
  const RelocalizationReport report = relocalizer_.relocalize(map_, index_, *mixed);
  const AcceptanceOptions& least = relocalizer_.options().acceptance;
  ASSERT_TRUE(report.has_pose);
  EXPECT_GE(report.confidence, least.min_confidence);  // by the points that agree alone
  EXPECT_GE(report.spread, least.min_spread);
  EXPECT_LT(report.coverage, least.min_coverage);
  EXPECT_FALSE(report.accepted);
}

TEST_F(RelocalizerTest, FindsNothingWithoutAGlobalDescriptorButTakesCandidates) {
  const SE3 truth = PointScene::pose(0.43);
  const FramePtr frame = one_.frame(100, truth);
  EXPECT_FALSE(relocalizer_.relocalize(map_, index_, *frame).has_pose);
  const RelocalizationReport report = relocalizer_.relocalize(map_, {{4U, 1.0F}}, *frame);
  EXPECT_TRUE(report.accepted);
  EXPECT_LT(translation_distance(report.world_from_camera, truth), 0.01);
}

TEST_F(RelocalizerTest, TakesEmptyFramesAndMaps) {
  Frame empty;
  empty.global = global_at(0.0);
  EXPECT_FALSE(relocalizer_.relocalize(map_, index_, empty).has_pose);
  const RelocalizationReport report =
      relocalizer_.relocalize(Map(), GlobalIndex(), *query(one_, SE3(), 0.0));
  EXPECT_FALSE(report.has_pose);
  EXPECT_EQ(report.groups_tried, 0);
}

TEST_F(RelocalizerTest, GivesTheSameAnswerTwice) {
  const FramePtr frame = query(one_, PointScene::pose(0.7), 0.14);
  const RelocalizationReport a = relocalizer_.relocalize(map_, index_, *frame);
  const RelocalizationReport b = relocalizer_.relocalize(map_, index_, *frame);
  EXPECT_EQ(a.world_from_camera.matrix(), b.world_from_camera.matrix());
  EXPECT_EQ(a.points, b.points);
}

TEST_F(RelocalizerTest, NamesTheOptionThatIsOutOfRange) {
  RelocalizationOptions options;
  options.acceptance.min_spread = 2.0;
  try {
    const Relocalizer relocalizer(one_.camera(), one_.traits(), options);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("relocalization.acceptance.min_spread"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace dxslam
