// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "loop_closing/loop_correction.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/options.h"
#include "loop_closing/ring_scene.h"

namespace dxslam {
namespace {

class LoopCorrectionTest : public testing::Test {
 protected:
  LoopVerification verify(const RingWalk& walk, KeyframeId query, KeyframeId candidate) {
    return verify_loop(walk.map, query, candidate, scene_.traits(), {});
  }
  /// A loop as a deceived verification would report it.
  static LoopVerification claim(KeyframeId query, KeyframeId candidate,
                                const SE3& candidate_from_query) {
    LoopVerification loop;
    loop.query = query;
    loop.candidate = candidate;
    loop.accepted = true;
    loop.candidate_from_query = candidate_from_query;
    return loop;
  }
  SE3 believed(const Map& map, KeyframeId a, KeyframeId b) {
    return map.keyframe(a).world_from_camera.inverse() * map.keyframe(b).world_from_camera;
  }
  LoopChange apply(const LoopPlan& plan, const LoopVerification& loop, Map& map) {
    return apply_loop_plan(plan, loop, scene_.traits(), options_, map, closed_);
  }
  static Drift strong_drift() {
    Drift drift;
    drift.turn_bias = 0.0015;
    drift.move_bias = 0.005;
    return drift;
  }

  RingScene scene_{10.0, 45.0};  // 63 m round
  LoopCorrectionOptions options_;
  std::vector<LoopEdge> closed_;
};

TEST_F(LoopCorrectionTest, WithoutContradictionNothingPulls) {
  RingWalk walk(scene_, strong_drift());
  walk.walk(0.0, 10.0);
  EssentialGraph essential = make_essential_graph(walk.map, 0, options_.min_shared, {}, {});
  ASSERT_EQ(essential.keyframes.size(), walk.map.keyframe_count());
  EXPECT_GE(essential.graph.edges.size() + 1, walk.map.keyframe_count());
  const PoseGraphReport report = optimize_pose_graph(essential.graph, options_.graph);
  EXPECT_LT(report.initial_cost, 1e-12);
  EXPECT_NEAR(path_length(essential, 0, 20), 10.0, 0.5);
}

TEST_F(LoopCorrectionTest, TheEssentialGraphKeepsClosedLoopsOfCulledKeyframes) {
  RingWalk walk(scene_);
  walk.walk(0.0, 10.0);
  const std::vector<LoopEdge> closed = {{2, 18}};
  const auto way = [&] {
    const EssentialGraph e = make_essential_graph(walk.map, 0, options_.min_shared, closed, {});
    return path_length(e, e.node_of(3), e.node_of(17));
  };
  const double chord = translation_distance(walk.truth(2), walk.truth(18));
  EXPECT_LT(way(), chord + 2.0);
  walk.map.remove_keyframe(18);
  EXPECT_LT(way(), chord + 2.0);
}

TEST_F(LoopCorrectionTest, SpreadsTheDriftOverTheLoopAndFusesPoints) {
  RingWalk walk(scene_, strong_drift());
  const KeyframeId query = walk.walk(0.0, scene_.circumference() + 1.5);
  const LoopVerification loop = verify(walk, query, 3);
  ASSERT_TRUE(loop.accepted) << describe(loop.rejection);
  const double before = walk.ate();
  const std::size_t points = walk.map.point_count();
  ASSERT_EQ(walk.map.best_covisibles(query, 100, 1).back().keyframe > 20, true);

  const LoopPlan plan = plan_loop_correction(walk.map, loop, closed_, options_);
  ASSERT_EQ(plan.effect, LoopEffect::kBend) << describe(plan.refusal);
  EXPECT_NEAR(plan.way_round, scene_.circumference(), 3.0);
  EXPECT_LT(plan.worst_bend, 1.0);
  const LoopChange change = apply(plan, loop, walk.map);
  EXPECT_EQ(change.moved_keyframes, static_cast<int>(walk.map.keyframe_count()));
  EXPECT_GT(change.fused_points, 50);
  EXPECT_LT(walk.map.point_count(), points);
  EXPECT_LT(walk.ate(), 0.2 * before);
  EXPECT_LT(translation_distance(believed(walk.map, 3, query), loop.candidate_from_query), 0.02);
  ASSERT_EQ(closed_.size(), 1U);
  // The two ends now see the same points.
  EXPECT_LT(walk.map.keyframe(query).covisibles.front().keyframe, 6U);
}

TEST_F(LoopCorrectionTest, PointsFollowTheirKeyframes) {
  RingWalk walk(scene_, strong_drift());
  const KeyframeId query = walk.walk(0.0, scene_.circumference() + 1.5);
  PointId point = kNoId;
  for (const PointId p : walk.map.keyframe(30).points) {
    if (walk.map.point(p).created_by == 30) point = p;
  }
  ASSERT_NE(point, kNoId);
  const auto seen = [&] {
    return (walk.map.keyframe(30).world_from_camera.inverse() * walk.map.point(point).position)
        .eval();
  };
  const Eigen::Vector3d before = seen();
  const LoopVerification loop = verify(walk, query, 3);
  ASSERT_TRUE(loop.accepted);
  apply(plan_loop_correction(walk.map, loop, closed_, options_), loop, walk.map);
  EXPECT_LT((seen() - before).norm(), 1e-9);
}

TEST_F(LoopCorrectionTest, WeldsWhereTheMapAgreesAlready) {
  RingWalk walk(scene_, {0.0, 0.00001, 0.0, 0.0001, 0.0});
  const KeyframeId query = walk.walk(0.0, scene_.circumference() + 1.5);
  const LoopVerification loop = verify(walk, query, 3);
  ASSERT_TRUE(loop.accepted);
  const MapState before(walk.map);
  const LoopPlan plan = plan_loop_correction(walk.map, loop, closed_, options_);
  EXPECT_EQ(plan.effect, LoopEffect::kWeld);
  const LoopChange change = apply(plan, loop, walk.map);
  EXPECT_EQ(change.moved_keyframes, 0);
  EXPECT_GT(change.fused_points, 50);
  EXPECT_EQ(MapState(walk.map).keyframes, before.keyframes);
  EXPECT_EQ(walk.map.keyframe(query).world_from_camera.translation(),
            before.poses[query].translation());
}

TEST_F(LoopCorrectionTest, ADoubleOfAPlaceIsRefusedAndTheMapUnchanged) {
  // The wall from 19 m on is in every detail that from 4 m on: the geometry cannot know better.
  scene_.copy_wall(2.0, 17.0, 6.0);
  RingWalk walk(scene_);
  const KeyframeId query = walk.walk(0.0, 20.0);
  const LoopVerification loop = verify(walk, query, 10);
  ASSERT_TRUE(loop.accepted) << describe(loop.rejection);
  const MapState before(walk.map);
  const LoopPlan plan = plan_loop_correction(walk.map, loop, closed_, options_);
  EXPECT_EQ(plan.refusal, LoopRefusal::kDrift) << describe(plan.refusal);
  apply(plan, loop, walk.map);
  EXPECT_TRUE(MapState(walk.map) == before);
  EXPECT_TRUE(closed_.empty());
}

TEST_F(LoopCorrectionTest, ALoopAgainstAnEarlierOneIsRefusedAndTheMapUnchanged) {
  RingWalk walk(scene_, strong_drift());
  KeyframeId query = walk.walk(0.0, scene_.circumference() + 1.5);
  const LoopVerification first = verify(walk, query, 3);
  ASSERT_TRUE(first.accepted);
  apply(plan_loop_correction(walk.map, first, closed_, options_), first, walk.map);

  // 60 m of odometry could hide this much drift, but not since the loop was closed.
  const SE3 wrong = believed(walk.map, 3, query) *
                    SE3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(1.5, 0.0, 0.0));
  options_.drift_allowance = 5.0;  // leave it to the optimisation
  const LoopVerification second = claim(query, 3, wrong);
  const MapState before(walk.map);
  const LoopPlan plan = plan_loop_correction(walk.map, second, closed_, options_);
  EXPECT_TRUE(plan.refusal == LoopRefusal::kLoopEdge || plan.refusal == LoopRefusal::kBentEdge)
      << describe(plan.refusal);
  apply(plan, second, walk.map);
  EXPECT_TRUE(MapState(walk.map) == before);
}

TEST_F(LoopCorrectionTest, ATurnThatOdometryCannotHaveMissedIsRefused) {
  RingWalk walk(scene_);
  const KeyframeId query = walk.walk(0.0, 10.0);
  const SE3 wrong = believed(walk.map, 1, query) *
                    SE3(so3_exp(Eigen::Vector3d(0.0, 1.0, 0.0)), Eigen::Vector3d::Zero());
  const LoopPlan plan = plan_loop_correction(walk.map, claim(query, 1, wrong), closed_, options_);
  EXPECT_EQ(plan.refusal, LoopRefusal::kDrift);
}

TEST_F(LoopCorrectionTest, JoinsComponentsIntoTheOlderOne) {
  RingWalk walk(scene_, strong_drift());
  walk.walk(0.0, 10.0);
  walk.add(12.0, true);
  walk.walk(11.5, 6.0, -0.5);
  const KeyframeId query = walk.map.last_keyframe();
  ASSERT_EQ(walk.map.keyframe(query).component, 1U);
  const LoopVerification loop = verify(walk, query, 12);
  ASSERT_TRUE(loop.accepted) << describe(loop.rejection);
  const SE3 untouched = walk.map.keyframe(12).world_from_camera;
  const LoopPlan plan = plan_loop_correction(walk.map, loop, closed_, options_);
  ASSERT_EQ(plan.effect, LoopEffect::kJoin);
  const LoopChange change = apply(plan, loop, walk.map);
  EXPECT_GT(change.fused_points, 30);
  EXPECT_GT(change.moved_points, 100);
  for (const KeyframeId id : walk.map.keyframe_ids()) {
    EXPECT_EQ(walk.map.keyframe(id).component, 0U);
  }
  EXPECT_EQ(walk.map.keyframe(12).world_from_camera.translation(), untouched.translation());
  EXPECT_LT(translation_distance(believed(walk.map, 12, query), loop.candidate_from_query), 1e-9);
  EXPECT_LT(walk.ate(), 0.15);

  // The other way round: seen from the older component, the younger one still comes over.
  const LoopVerification reverse =
      claim(loop.candidate, loop.query, loop.candidate_from_query.inverse());
  RingWalk again(scene_, strong_drift());
  again.walk(0.0, 10.0);
  again.add(12.0, true);
  again.walk(11.5, 6.0, -0.5);
  const LoopPlan back = plan_loop_correction(again.map, reverse, closed_, options_);
  EXPECT_EQ(back.parent, loop.candidate);
  EXPECT_LT(
      translation_distance(back.parent_world_from_child_world, plan.parent_world_from_child_world),
      1e-9);
}

TEST_F(LoopCorrectionTest, TakesDriftInScaleOut) {
  Drift drift = strong_drift();
  drift.scale_bias = 0.0015;  // 20 % after a round
  RingWalk walk(scene_, drift);
  const KeyframeId query = walk.walk(0.0, scene_.circumference() + 1.5);
  // Depths are of no use to a camera without them, and would contradict the scale.
  LoopVerificationOptions verification;
  verification.depth_tolerance = 10.0;
  const LoopVerification loop = verify_loop(walk.map, query, 3, scene_.traits(), verification);
  ASSERT_TRUE(loop.accepted) << describe(loop.rejection);
  const double expected = std::exp(-drift.scale_bias * 2.0 * scene_.circumference());
  EXPECT_NEAR(loop.scale, expected, 0.02);
  const double before = walk.ate(0, true);
  options_.graph.with_scale = true;
  const LoopPlan plan = plan_loop_correction(walk.map, loop, closed_, options_);
  ASSERT_EQ(plan.effect, LoopEffect::kBend) << describe(plan.refusal);
  apply(plan, loop, walk.map);
  EXPECT_LT(walk.ate(0, true), 0.25 * before);
  // The last points are as large as the first again.
  const Keyframe& k = walk.map.keyframe(query);
  double ratio = 0.0;
  int n = 0;
  for (std::size_t i = 0; i < k.points.size(); ++i) {
    if (k.points[i] == kNoId) continue;
    const Eigen::Vector3d p = k.world_from_camera.inverse() * walk.map.point(k.points[i]).position;
    ratio += p.z() / static_cast<double>(k.frame->depths[i]);
    ++n;
  }
  EXPECT_NEAR(ratio / n, 1.0, 0.05);
}

TEST_F(LoopCorrectionTest, OptionsAreChecked) {
  EXPECT_NO_THROW(validate_options("correction", options_));
  options_.drift_per_metre = -1.0;
  EXPECT_THROW(validate_options("correction", options_), InputError);
  EXPECT_THROW(plan_loop_correction(Map(), LoopVerification(), {}, options_), ContractError);
}

}  // namespace
}  // namespace dxslam
