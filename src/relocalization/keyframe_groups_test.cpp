// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "relocalization/keyframe_groups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "relocalization/test_map.h"

namespace dxslam {
namespace {

using testing::ElementsAre;

class KeyframeGroups : public testing::Test {
 protected:
  KeyframeGroups() {
    first_ = add_scene(one_, 8, 0.0, SE3(), map_);
    second_ = add_scene(other_, 8, 1.0, SE3(), map_);
  }

  PointScene one_{800, 1};
  PointScene other_{800, 2};
  Map map_;
  std::vector<KeyframeId> first_;
  std::vector<KeyframeId> second_;
};

TEST_F(KeyframeGroups, NeighboursGoTogetherAndComponentsApart) {
  const std::vector<GlobalMatch> candidates = {
      {first_[0], 0.9F}, {second_[3], 0.8F}, {first_[1], 0.7F}, {second_[4], 0.6F}};
  const std::vector<CandidateGroup> groups = group_by_covisibility(map_, candidates, 20, 2);
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_THAT(groups[0].keyframes, ElementsAre(first_[0], first_[1]));
  EXPECT_EQ(groups[0].component, 0U);
  EXPECT_THAT(groups[1].keyframes, ElementsAre(second_[3], second_[4]));
  EXPECT_EQ(groups[1].component, 1U);
}

TEST_F(KeyframeGroups, ManyGoodCandidatesBeatASingleBestOne) {
  const std::vector<GlobalMatch> candidates = {{second_[0], 0.85F},
                                               {first_[0], 0.8F},
                                               {first_[1], 0.8F},
                                               {first_[2], 0.8F},
                                               {second_[7], 0.1F}};
  const std::vector<CandidateGroup> groups = group_by_covisibility(map_, candidates, 20, 3);
  ASSERT_GE(groups.size(), 2U);
  EXPECT_EQ(groups[0].component, 0U);
}

TEST_F(KeyframeGroups, ASmallGroupIsFilledUpWithCovisibles) {
  const std::vector<CandidateGroup> groups =
      group_by_covisibility(map_, {{first_[3], 0.9F}}, 20, 5);
  ASSERT_EQ(groups.size(), 1U);
  ASSERT_EQ(groups[0].keyframes.size(), 5U);
  EXPECT_EQ(groups[0].keyframes.front(), first_[3]);
  for (const KeyframeId id : groups[0].keyframes) EXPECT_EQ(map_.keyframe(id).component, 0U);
}

TEST_F(KeyframeGroups, ALargeGroupIsCutAndItsRestMakesNoOther) {
  std::vector<GlobalMatch> candidates;
  for (std::size_t i = 0; i < 5; ++i) candidates.push_back({first_[i], 0.9F - 0.1F * i});
  const std::vector<CandidateGroup> groups = group_by_covisibility(map_, candidates, 1, 2);
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_THAT(groups[0].keyframes, ElementsAre(first_[0], first_[1]));
}

TEST_F(KeyframeGroups, KeyframesThatAreGoneArePassedOver) {
  map_.remove_keyframe(first_[7]);
  const std::vector<CandidateGroup> groups =
      group_by_covisibility(map_, {{first_[7], 0.9F}, {first_[2], 0.8F}, {4711, 0.7F}}, 20, 1);
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_THAT(groups[0].keyframes, ElementsAre(first_[2]));
  EXPECT_TRUE(group_by_covisibility(map_, {}, 20, 5).empty());
}

}  // namespace
}  // namespace dxslam
