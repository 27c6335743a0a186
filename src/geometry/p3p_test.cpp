// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "geometry/p3p.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "geometry/geometry_scene.h"

namespace dxslam {
namespace {

struct P3pProblem {
  SE3 world_from_camera;
  std::array<Eigen::Vector3d, 3> points;
  std::array<Eigen::Vector3d, 3> rays;
};

P3pProblem random_problem(SampleSource& source) {
  const Camera camera = test_camera();
  P3pProblem problem;
  problem.world_from_camera = SE3::exp(source.tangent(2.0));
  for (std::size_t i = 0; i < 3; ++i) {
    problem.rays[i] = source.uniform(0.1, 10.0) * camera.unproject(random_pixel(source), 1.0);
    const double depth = source.uniform(0.5, 6.0) / problem.rays[i].z();
    problem.points[i] = problem.world_from_camera * (depth * problem.rays[i]);
  }
  return problem;
}

double distance_to_truth(const P3pSolutions& solutions, const SE3& world_from_camera) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < solutions.count; ++i) {
    const SE3& pose = solutions.camera_from_world[static_cast<std::size_t>(i)];
    nearest = std::min(nearest, (pose * world_from_camera).log().norm());
  }
  return nearest;
}

TEST(P3p, AlwaysHasTheTruePoseAmongItsSolutions) {
  SampleSource source(1);
  for (int i = 0; i < 5000; ++i) {
    const P3pProblem problem = random_problem(source);
    EXPECT_LT(distance_to_truth(solve_p3p(problem.points, problem.rays), problem.world_from_camera),
              1e-5);
  }
}

TEST(P3p, EverySolutionExplainsTheRays) {
  SampleSource source(2);
  int several = 0;
  for (int i = 0; i < 1000; ++i) {
    const P3pProblem problem = random_problem(source);
    const P3pSolutions solutions = solve_p3p(problem.points, problem.rays);
    if (solutions.count > 1) ++several;
    for (int k = 0; k < solutions.count; ++k) {
      for (std::size_t j = 0; j < 3; ++j) {
        const Eigen::Vector3d p =
            solutions.camera_from_world[static_cast<std::size_t>(k)] * problem.points[j];
        EXPECT_GT(p.normalized().dot(problem.rays[j].normalized()), 1.0 - 1e-10);
      }
    }
  }
  EXPECT_GT(several, 300);
}

TEST(P3p, SolvesSymmetricConfigurations) {
  // An equilateral triangle seen head-on: equal distances and cosines, where closed forms divide
  // by differences.
  std::array<Eigen::Vector3d, 3> rays;
  std::array<Eigen::Vector3d, 3> points;
  for (std::size_t i = 0; i < 3; ++i) {
    const double angle = 2.0 * M_PI * static_cast<double>(i) / 3.0;
    rays[i] = Eigen::Vector3d(0.3 * std::cos(angle), 0.3 * std::sin(angle), 1.0);
    points[i] = 2.0 * rays[i];
  }
  EXPECT_LT(distance_to_truth(solve_p3p(points, rays), SE3()), 1e-6);
}

TEST(P3p, HasNoSolutionForDegenerateInput) {
  SampleSource source(3);
  P3pProblem problem = random_problem(source);
  problem.points[2] = 0.3 * problem.points[0] + 0.7 * problem.points[1];
  EXPECT_EQ(solve_p3p(problem.points, problem.rays).count, 0);
  problem.points[2] = problem.points[0];
  EXPECT_EQ(solve_p3p(problem.points, problem.rays).count, 0);
  problem = random_problem(source);
  problem.points[1].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(solve_p3p(problem.points, problem.rays).count, 0);
  problem = random_problem(source);
  problem.rays[1].setZero();
  EXPECT_EQ(solve_p3p(problem.points, problem.rays).count, 0);
}

TEST(AlignTriangles, IsExactForCongruentOnes) {
  SampleSource source(4);
  for (const SE3& truth : sample_poses()) {
    const std::array<Eigen::Vector3d, 3> a = {source.vector(2.0), source.vector(2.0),
                                              source.vector(2.0)};
    const std::array<Eigen::Vector3d, 3> b = {truth * a[0], truth * a[1], truth * a[2]};
    EXPECT_LT((align_triangles(a, b).matrix() - truth.matrix()).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace dxslam
