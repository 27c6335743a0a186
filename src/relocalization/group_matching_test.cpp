// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "relocalization/group_matching.h"

#include <gtest/gtest.h>

#include <set>

#include "relocalization/test_map.h"

namespace dxslam {
namespace {

TEST(GroupPoints, EveryPointIsThereOnce) {
  PointScene scene(600);
  Map map;
  const std::vector<KeyframeId> ids = add_scene(scene, 6, 0.0, SE3(), map);
  std::set<PointId> expected;
  for (const KeyframeId id : ids) {
    expected.insert(map.keyframe(id).points.begin(), map.keyframe(id).points.end());
  }
  expected.erase(kNoId);
  // The scene gives a point the same descriptor in every image: more than one would be waste.
  const GroupPoints group = gather_group_points(map, ids, 3, 100000, 0.6F);
  EXPECT_EQ(std::set<PointId>(group.ids.begin(), group.ids.end()), expected);
  EXPECT_EQ(group.ids.size(), expected.size());
  EXPECT_EQ(group.descriptors.rows, static_cast<int>(group.ids.size()));
  EXPECT_EQ(group.point_of_row.size(), group.ids.size());
}

// A map of one keyframe with these descriptors as its points, in a row 1 m apart.
Map map_of(const cv::Mat& descriptors, double apart = 1.0) {
  auto frame = std::make_shared<Frame>();
  const std::size_t n = static_cast<std::size_t>(descriptors.rows);
  frame->pixels.assign(n, Eigen::Vector2f::Zero());
  frame->depths.assign(n, 1.0F);
  frame->scores.assign(n, 1.0F);
  frame->sigmas.assign(n, 1.0F);
  frame->descriptors = descriptors;
  Map map;
  const KeyframeId id = map.add_keyframe(frame, SE3(), kNoId);
  for (std::uint32_t i = 0; i < n; ++i) map.add_point({apart * i, 0.0, 1.0}, id, i);
  return map;
}

cv::Mat rows(std::initializer_list<double> angles) {
  cv::Mat descriptors(static_cast<int>(angles.size()), 2, CV_32F);
  int row = 0;
  for (const double angle : angles) {
    descriptors.at<float>(row, 0) = static_cast<float>(std::cos(angle));
    descriptors.at<float>(row++, 1) = static_cast<float>(std::sin(angle));
  }
  return descriptors;
}

TEST(GroupPoints, AChangedLookIsKeptBesideTheFirst) {
  Map map = map_of(rows({0.0}));
  auto frame = std::make_shared<Frame>(*map.keyframe(0).frame);
  frame->descriptors = rows({0.8});
  const KeyframeId second = map.add_keyframe(frame, SE3(), 0);
  map.add_observation(0, second, 0);
  EXPECT_EQ(gather_group_points(map, {0, second}, 2, 100, 0.9F).descriptors.rows, 2);
  EXPECT_EQ(gather_group_points(map, {0, second}, 1, 100, 0.9F).descriptors.rows, 1);
  EXPECT_EQ(gather_group_points(map, {0, second}, 2, 1, 0.9F).descriptors.rows, 1);
  EXPECT_EQ(gather_group_points(map, {0, second}, 2, 100, 3.0F).descriptors.rows, 1);
}

TEST(GroupMatching, FindsMutualNearestNeighbours) {
  const Map map = map_of(rows({0.0, 1.0, 2.0}));
  const GroupPoints group = gather_group_points(map, {0}, 1, 100, 0.9F);
  // The last keypoint is farther from point 1 than the second is.
  const std::vector<GroupMatch> matches =
      match_group(rows({2.05, 1.02, 1.1}), 100, group, 0.9F, 0.95F);
  ASSERT_EQ(matches.size(), 2U);
  EXPECT_EQ(matches[0].keypoint, 0);
  EXPECT_EQ(matches[0].point, 2);
  EXPECT_NEAR(matches[0].distance, 0.05F, 1e-3F);
  EXPECT_EQ(matches[1].keypoint, 1);
  EXPECT_EQ(matches[1].point, 1);
}

TEST(GroupMatching, AKeypointBetweenTwoPointsIsAmbiguous) {
  const GroupPoints apart = gather_group_points(map_of(rows({0.0, 0.4})), {0}, 1, 100, 0.9F);
  EXPECT_TRUE(match_group(rows({0.199}), 100, apart, 0.9F, 0.95F).empty());
  EXPECT_EQ(match_group(rows({0.199}), 100, apart, 0.9F, 1.0F).size(), 1U);
  const GroupPoints same = gather_group_points(map_of(rows({0.0, 0.4}), 0.01), {0}, 1, 100, 0.9F);
  EXPECT_EQ(match_group(rows({0.199}), 100, same, 0.9F, 0.95F).size(), 1U)
      << "two points of one place are no rivals";
}

TEST(GroupMatching, KeepsToTheLimits) {
  const GroupPoints group = gather_group_points(map_of(rows({0.0, 1.0})), {0}, 1, 100, 0.9F);
  EXPECT_TRUE(match_group(rows({2.2}), 100, group, 0.9F, 1.0F).empty()) << "too far";
  EXPECT_EQ(match_group(rows({1.0, 0.0}), 1, group, 0.9F, 1.0F).size(), 1U) << "one keypoint only";
  EXPECT_TRUE(match_group(cv::Mat(), 100, group, 0.9F, 1.0F).empty());
  EXPECT_TRUE(match_group(rows({1.0}), 100, GroupPoints(), 0.9F, 1.0F).empty());
}

}  // namespace
}  // namespace dxslam
