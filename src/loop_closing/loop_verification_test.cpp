// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "loop_closing/loop_verification.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/options.h"
#include "loop_closing/ring_scene.h"

namespace dxslam {
namespace {

class LoopVerificationTest : public testing::Test {
 protected:
  LoopVerification verify(const RingWalk& walk, KeyframeId query, KeyframeId candidate) {
    return verify_loop(walk.map, query, candidate, scene_.traits(), options_);
  }

  RingScene scene_{10.0, 45.0};  // 63 m round
  LoopVerificationOptions options_;
};

TEST_F(LoopVerificationTest, FindsTheTrueRelativePoseWhateverTheDrift) {
  Drift drift;
  drift.turn_bias = 0.002;
  drift.move_bias = 0.005;
  RingWalk walk(scene_, drift);
  const KeyframeId query = walk.walk(0.0, scene_.circumference() + 1.2, 0.25);
  const KeyframeId candidate = 5;  // 1.25 m along the ring
  const SE3 truth = walk.truth(candidate).inverse() * walk.truth(query);
  const SE3 believed = walk.map.keyframe(candidate).world_from_camera.inverse() *
                       walk.map.keyframe(query).world_from_camera;
  ASSERT_GT(translation_distance(truth, believed), 0.5);

  const LoopVerification loop = verify(walk, query, candidate);
  ASSERT_TRUE(loop.accepted) << describe(loop.rejection);
  EXPECT_LT(translation_distance(truth, loop.candidate_from_query), 0.03);
  EXPECT_LT(rotation_angle(truth, loop.candidate_from_query), 0.01);
  EXPECT_NEAR(loop.scale, 1.0, 0.02);
  EXPECT_GE(loop.confirmations, options_.min_confirmations);
  EXPECT_EQ(loop.inlier_matches.size(), static_cast<std::size_t>(loop.inliers));
}

TEST_F(LoopVerificationTest, RefusesAnotherPlace) {
  RingWalk walk(scene_);
  const KeyframeId query = walk.walk(0.0, 25.0);
  const LoopVerification loop = verify(walk, query, 10);
  EXPECT_FALSE(loop.accepted);
  EXPECT_EQ(loop.rejection, LoopRejection::kFewMatches) << describe(loop.rejection);
}

TEST_F(LoopVerificationTest, RefusesNeighboursAndWhatIsGone) {
  RingWalk walk(scene_);
  const KeyframeId query = walk.walk(0.0, 10.0);
  EXPECT_EQ(verify(walk, query, query - 1).rejection, LoopRejection::kConnected);
  EXPECT_EQ(verify(walk, query, query).rejection, LoopRejection::kConnected);
  EXPECT_EQ(verify(walk, query, 1000).rejection, LoopRejection::kGone);
  EXPECT_THROW(verify(walk, 1000, query), ContractError);
}

TEST_F(LoopVerificationTest, APictureThatHangsTwiceIsNoLoop) {
  // A strip of the wall at 20 m looks like that at 5 m: plenty of matches and a perfect pose.
  scene_.copy_wall(4.0, 19.0, 2.0, -1.5, -0.75);
  options_.min_found_share = 0.0;
  options_.min_inliers = 20;
  RingWalk walk(scene_);
  const KeyframeId query = walk.walk(0.0, 20.0);
  const LoopVerification loop = verify(walk, query, 10);
  EXPECT_GE(loop.inliers, options_.min_inliers);
  EXPECT_GE(loop.cells, options_.min_cells);
  EXPECT_EQ(loop.rejection, LoopRejection::kNarrow)
      << describe(loop.rejection) << ", " << loop.covered_share << " covered";
}

TEST_F(LoopVerificationTest, MostOfWhatShouldBeInViewMustBeThere) {
  // Two of three points look different now: what is left lies all over the image.
  RingWalk walk(scene_);
  walk.walk(0.0, 8.0);
  std::vector<int> sources;
  const FramePtr whole = scene_.frame(99, 4.0, sources);
  Frame thinned = *whole;
  thinned.descriptors = whole->descriptors.clone();
  for (int i = 0; i < thinned.descriptors.rows; ++i) {
    if (i % 3 != 0) thinned.descriptors.row(i) *= -1.0;
  }
  const KeyframeId query = walk.map.add_keyframe(std::make_shared<Frame>(thinned), SE3(), kNoId);
  options_.min_covered_share = 0.0;
  EXPECT_TRUE(verify(walk, query, 8).accepted);
  options_.min_found_share = 0.5;
  EXPECT_EQ(verify(walk, query, 8).rejection, LoopRejection::kFewFound);
}

TEST_F(LoopVerificationTest, NeighboursThatSeeAnotherPlaceDoNotConfirm) {
  // The camera jumps to a place it knows in the middle of a place it does not.
  RingWalk walk(scene_);
  walk.walk(0.0, 8.0);
  walk.add(12.0, true);
  walk.walk(12.2, 14.0, 0.2);
  const KeyframeId query = walk.map.last_keyframe();
  std::vector<int> sources;
  Map& map = walk.map;
  const KeyframeId jumped = map.add_keyframe(scene_.frame(99, 4.0, sources),
                                             map.keyframe(query).world_from_camera, query);
  // Bound to the neighbours' points as a confused tracker would.
  for (std::uint32_t i = 0; i < 20; ++i) {
    for (const PointId p : map.keyframe(query).points) {
      if (p != kNoId && map.add_observation(p, jumped, i)) break;
    }
  }
  const LoopVerification loop = verify(walk, jumped, 8);
  EXPECT_GE(loop.inliers, options_.min_inliers);
  EXPECT_GT(loop.confirming, 0);
  EXPECT_EQ(loop.rejection, LoopRejection::kUnconfirmed) << describe(loop.rejection);
}

TEST_F(LoopVerificationTest, DepthsBearWitness) {
  // Another world in which everything is half as large again: same pixels, other depths.
  RingWalk walk(scene_);
  walk.walk(0.0, 8.0);
  std::vector<int> sources;
  Frame larger = *scene_.frame(99, 4.0, sources);
  for (float& depth : larger.depths) depth *= 1.5F;
  const KeyframeId query = walk.map.add_keyframe(std::make_shared<Frame>(larger), SE3(), kNoId);
  const LoopVerification loop = verify(walk, query, 8);
  EXPECT_FALSE(loop.accepted);
  EXPECT_EQ(loop.rejection, LoopRejection::kNoPose) << describe(loop.rejection);
}

TEST_F(LoopVerificationTest, WorksBetweenComponents) {
  RingWalk walk(scene_);
  walk.walk(0.0, 8.0);
  walk.add(3.0, true);
  const KeyframeId query = walk.walk(3.5, 5.0);
  const LoopVerification loop = verify(walk, query, 9);
  ASSERT_TRUE(loop.accepted) << describe(loop.rejection);
  EXPECT_LT(
      translation_distance(walk.truth(9).inverse() * walk.truth(query), loop.candidate_from_query),
      0.02);
}

TEST_F(LoopVerificationTest, OptionsAreChecked) {
  EXPECT_NO_THROW(validate_options("verification", options_));
  options_.min_found_share = 1.5;
  EXPECT_THROW(validate_options("verification", options_), InputError);
}

}  // namespace
}  // namespace dxslam
