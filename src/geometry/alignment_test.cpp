// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "geometry/alignment.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>

#include "core/error.h"
#include "core/transform_samples.h"

namespace dxslam {
namespace {

std::vector<Eigen::Vector3d> cloud(SampleSource& source, int n) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < n; ++i) points.push_back(source.vector(2.0));
  return points;
}

std::vector<Eigen::Vector3d> moved(const Sim3& motion, const std::vector<Eigen::Vector3d>& points) {
  std::vector<Eigen::Vector3d> result;
  for (const Eigen::Vector3d& p : points) result.push_back(motion * p);
  return result;
}

double squared_error(const Sim3& motion, const std::vector<Eigen::Vector3d>& source,
                     const std::vector<Eigen::Vector3d>& target) {
  double sum = 0.0;
  for (std::size_t i = 0; i < source.size(); ++i) {
    sum += (motion * source[i] - target[i]).squaredNorm();
  }
  return sum;
}

TEST(AlignPoints, FindsAnyMotionWithAndWithoutScale) {
  SampleSource source(1);
  for (const Sim3& truth : sample_similarities()) {
    const std::vector<Eigen::Vector3d> points = cloud(source, 12);
    const auto similar = align_points(points, moved(truth, points), true);
    ASSERT_TRUE(similar);
    EXPECT_LT((similar->matrix() - truth.matrix()).norm(), 1e-11);

    const Sim3 rigid(truth.rigid());
    const auto motion = align_points(points, moved(rigid, points), false);
    ASSERT_TRUE(motion);
    EXPECT_EQ(motion->scale(), 1.0);
    EXPECT_LT((motion->matrix() - rigid.matrix()).norm(), 1e-11);
  }
}

TEST(AlignPoints, AgreesWithEigenOnNoisyPoints) {
  SampleSource source(2);
  for (int round = 0; round < 20; ++round) {
    const Sim3 truth(source.uniform(0.2, 3.0), so3_exp(source.vector(2.0)), source.vector(5.0));
    const std::vector<Eigen::Vector3d> points = cloud(source, 10);
    std::vector<Eigen::Vector3d> target = moved(truth, points);
    Eigen::Matrix3Xd a(3, 10);
    Eigen::Matrix3Xd b(3, 10);
    for (int i = 0; i < 10; ++i) {
      target[static_cast<std::size_t>(i)] += source.vector(0.3);
      a.col(i) = points[static_cast<std::size_t>(i)];
      b.col(i) = target[static_cast<std::size_t>(i)];
    }
    for (const bool with_scale : {false, true}) {
      const auto motion = align_points(points, target, with_scale);
      ASSERT_TRUE(motion);
      EXPECT_LT((motion->matrix() - Eigen::umeyama(a, b, with_scale)).norm(), 1e-10);
    }
  }
}

TEST(AlignPoints, IsTheLeastSquaresMinimum) {
  SampleSource source(3);
  const std::vector<Eigen::Vector3d> points = cloud(source, 15);
  std::vector<Eigen::Vector3d> target =
      moved(Sim3(1.3, so3_exp({0.4, 0.1, 1.0}), {1, 2, 3}), points);
  for (Eigen::Vector3d& p : target) p += source.vector(0.2);
  const auto best = align_points(points, target, true);
  ASSERT_TRUE(best);
  const double least = squared_error(*best, points, target);
  for (int i = 0; i < 200; ++i) {
    Vector7d v;
    v << source.tangent(1e-3), source.uniform(-1e-3, 1e-3);
    EXPECT_GE(squared_error(Sim3::exp(v) * *best, points, target), least);
  }
}

TEST(AlignPoints, NeverReflects) {
  SampleSource source(4);
  const std::vector<Eigen::Vector3d> points = cloud(source, 8);
  std::vector<Eigen::Vector3d> mirrored = points;
  for (Eigen::Vector3d& p : mirrored) p.x() = -p.x();
  const auto motion = align_points(points, mirrored, false);
  ASSERT_TRUE(motion);
  EXPECT_NEAR(motion->rotation().toRotationMatrix().determinant(), 1.0, 1e-12);
}

TEST(AlignPoints, HandlesPointsInAPlane) {
  SampleSource source(5);
  const Sim3 truth(1.0, so3_exp({0.2, -1.0, 0.5}), {1, 2, 3});
  std::vector<Eigen::Vector3d> points = cloud(source, 3);
  const auto three = align_points(points, moved(truth, points), false);
  ASSERT_TRUE(three);
  EXPECT_LT((three->matrix() - truth.matrix()).norm(), 1e-11);
}

TEST(AlignPoints, RefusesPointsThatFixNoMotion) {
  const std::vector<Eigen::Vector3d> two = {{0, 0, 0}, {1, 0, 0}};
  EXPECT_FALSE(align_points(two, two, true));
  EXPECT_FALSE(align_points({}, {}, false));

  std::vector<Eigen::Vector3d> line;
  std::vector<Eigen::Vector3d> spread;
  SampleSource source(6);
  const Eigen::Vector3d direction = source.direction(1.0);
  for (int i = 0; i < 10; ++i) {
    line.push_back(Eigen::Vector3d(100.0, 20.0, -3.0) + 0.37 * i * direction);
    spread.push_back(source.vector(1.0));
  }
  EXPECT_FALSE(align_points(line, line, true));
  EXPECT_FALSE(align_points(line, spread, false));
  EXPECT_FALSE(align_points(spread, line, false));
  const std::vector<Eigen::Vector3d> same(5, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_FALSE(align_points(same, same, true));
}

TEST(AlignPoints, RefusesValuesThatAreNotFinite) {
  SampleSource source(7);
  const std::vector<Eigen::Vector3d> points = cloud(source, 6);
  std::vector<Eigen::Vector3d> broken = points;
  broken[2].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(align_points(points, broken, false));
  EXPECT_FALSE(align_points(broken, points, true));
}

TEST(AlignPoints, ThrowsOnDifferentSizes) {
  const std::vector<Eigen::Vector3d> three(3, Eigen::Vector3d::Zero());
  EXPECT_THROW(align_points(three, {}, true), ContractError);
}

}  // namespace
}  // namespace dxslam
