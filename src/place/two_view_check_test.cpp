// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "place/two_view_check.h"

#include <gtest/gtest.h>

#include "core/se3.h"
#include "core/transform_samples.h"

namespace dxslam {
namespace {

constexpr int kPoints = 120;

// The same random unit descriptors in both images.
cv::Mat random_descriptors(SampleSource& source) {
  cv::Mat rows(kPoints, 32, CV_32F);
  for (int i = 0; i < rows.rows; ++i) {
    for (int j = 0; j < rows.cols; ++j) {
      rows.at<float>(i, j) = static_cast<float>(source.normal());
    }
    cv::Mat row = rows.row(i);
    cv::normalize(row, row);
  }
  return rows;
}

// Points of a box seen from two poses, or in the second view at places that mean nothing.
std::pair<Features, Features> two_views(bool same_scene) {
  SampleSource source(5);
  Features a;
  Features b;
  a.descriptors = random_descriptors(source);
  b.descriptors = a.descriptors.clone();
  const SE3 b_from_a(so3_exp({0.02, 0.2, -0.05}), {-0.6, 0.1, 0.2});
  const auto pixel = [](const Eigen::Vector3d& p) {
    return Keypoint{static_cast<float>(500 * p.x() / p.z() + 320),
                    static_cast<float>(500 * p.y() / p.z() + 240), 1.0F, 1.0F};
  };
  for (int i = 0; i < kPoints; ++i) {
    const Eigen::Vector3d point = source.vector(1.0) + Eigen::Vector3d(0, 0, 4);
    const Eigen::Vector3d other = source.vector(1.0) + Eigen::Vector3d(0, 0, 4);
    a.keypoints.push_back(pixel(point));
    b.keypoints.push_back(pixel(b_from_a * (same_scene ? point : other)));
  }
  return {a, b};
}

const DescriptorTraits kTraits{false, 32, 0.7F, 0};

TEST(TwoViewCheck, CountsMatchesThatAgreeOnAMotion) {
  const auto [a, b] = two_views(true);
  EXPECT_GE(count_epipolar_inliers(a, b, kTraits), kPoints * 95 / 100);
  EXPECT_EQ(count_epipolar_inliers(a, b, kTraits), count_epipolar_inliers(a, b, kTraits));
}

TEST(TwoViewCheck, FindsNoMotionInMatchesThatMeanNothing) {
  const auto [a, b] = two_views(false);
  EXPECT_LT(count_epipolar_inliers(a, b, kTraits), kPoints / 3);
}

TEST(TwoViewCheck, AsksForEightMatches) {
  auto [a, b] = two_views(true);
  a.keypoints.resize(7);
  a.descriptors = a.descriptors.rowRange(0, 7);
  EXPECT_EQ(count_epipolar_inliers(a, b, kTraits), 0);
  EXPECT_EQ(count_epipolar_inliers({}, b, kTraits), 0);
}

}  // namespace
}  // namespace dxslam
