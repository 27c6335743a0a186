// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "optimization/pose_optimizer.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "core/options.h"
#include "geometry/geometry_scene.h"
#include "optimization/test_least_squares.h"

namespace dxslam {
namespace {

struct PoseScene {
  SE3 truth;
  std::vector<PoseObservation> observations;
  std::vector<char> outlier;
};

PoseScene make_scene(SampleSource& source, int n, double outlier_share, double noise) {
  const Camera camera = test_camera();
  PoseScene scene;
  scene.truth = SE3::exp(source.tangent(1.0));
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector2d pixel = random_pixel(source);
    const double depth = source.uniform(0.5, 5.0);
    PoseObservation o;
    o.point_in_world = scene.truth * camera.unproject(pixel, depth);
    o.measured.sigma = source.uniform(0.7, 1.5);
    const double dx = noise * o.measured.sigma * source.normal();
    const double dy = noise * o.measured.sigma * source.normal();
    o.measured.pixel = pixel + Eigen::Vector2d(dx, dy);
    if (i % 3 != 0)
      o.measured.disparity = camera.bf() / depth + noise * o.measured.sigma * source.normal();
    const bool outlier = source.uniform(0.0, 1.0) < outlier_share;
    if (outlier) o.measured.pixel = random_pixel(source);
    scene.observations.push_back(o);
    scene.outlier.push_back(outlier ? 1 : 0);
  }
  return scene;
}

SE3 nearby(SampleSource& source, const SE3& pose, double extent) {
  return pose * SE3::exp(source.tangent(extent));
}

/// The least-squares minimum over the observations in use, by MINPACK; huber: width of the kernel,
/// 0 for none.
SE3 oracle(const SE3& start, const std::vector<PoseObservation>& observations,
           const std::vector<char>& use, double huber) {
  const Camera camera = test_camera();
  const SE3 camera_from_world = start.inverse();
  const auto residuals = [&](const Eigen::VectorXd& delta, Eigen::VectorXd& r) {
    const SE3 pose = SE3::exp(Vector6d(delta)) * camera_from_world;
    r.setZero();
    for (std::size_t i = 0; i < observations.size(); ++i) {
      if (use[i] == 0) continue;
      const PoseObservation& o = observations[i];
      const Eigen::Vector3d p = pose * o.point_in_world;
      const double u = camera.fx * p.x() / p.z() + camera.cx;
      const double v = camera.fy * p.y() / p.z() + camera.cy;
      Eigen::Vector3d part(u - o.measured.pixel.x(), v - o.measured.pixel.y(), 0.0);
      if (o.measured.has_disparity())
        part.z() = u - camera.bf() / p.z() - o.measured.pixel.x() + o.measured.disparity;
      part /= o.measured.sigma;
      const double scale = huber > 0.0 ? huber_scale(part.squaredNorm(), huber * huber) : 1.0;
      r.segment<3>(3 * static_cast<Eigen::Index>(i)) = scale * part;
    }
  };
  const Vector6d delta =
      minimise_by_minpack(6, 3 * static_cast<Eigen::Index>(observations.size()), residuals);
  return (SE3::exp(delta) * camera_from_world).inverse();
}

TEST(PoseOptimizer, RecoversAnExactPose) {
  SampleSource source(1);
  for (int i = 0; i < 20; ++i) {
    const PoseScene scene = make_scene(source, 60, 0.0, 0.0);
    const PoseReport report =
        optimize_pose(test_camera(), nearby(source, scene.truth, 0.05), scene.observations, {});
    ASSERT_TRUE(report.success);
    EXPECT_EQ(report.inliers, 60);
    EXPECT_LT(translation_distance(report.world_from_camera, scene.truth), 1e-8);
    EXPECT_LT(rotation_angle(report.world_from_camera, scene.truth), 1e-8);
    EXPECT_LT(report.rms_pixels, 1e-5);
  }
}

TEST(PoseOptimizer, EndsAtTheLeastSquaresMinimumOfItsInliers) {
  SampleSource source(2);
  for (int i = 0; i < 20; ++i) {
    const PoseScene scene = make_scene(source, 100, 0.2, 1.0);
    const PoseReport report =
        optimize_pose(test_camera(), nearby(source, scene.truth, 0.05), scene.observations, {});
    ASSERT_TRUE(report.success);
    // The gates are read once more at the end; with many rounds that no longer changes the set.
    PoseOptimizerOptions settled;
    settled.rounds = 12;
    const PoseReport more =
        optimize_pose(test_camera(), report.world_from_camera, scene.observations, settled);
    ASSERT_TRUE(more.success);
    const SE3 expected = oracle(more.world_from_camera, scene.observations, more.inlier, 0.0);
    EXPECT_LT(translation_distance(more.world_from_camera, expected), 1e-6);
    EXPECT_LT(rotation_angle(more.world_from_camera, expected), 1e-6);
    EXPECT_LT(translation_distance(report.world_from_camera, expected), 2e-3);
  }
}

TEST(PoseOptimizer, AgreesWithMinpackUnderTheKernel) {
  SampleSource source(3);
  for (int i = 0; i < 10; ++i) {
    const PoseScene scene = make_scene(source, 100, 0.2, 1.0);
    PoseOptimizerOptions options;
    options.rounds = 1;
    options.iterations = 100;
    options.chi2_pixel = options.chi2_depth = 6.5;  // one width of the kernel, as in the oracle
    const PoseReport report = optimize_pose(test_camera(), nearby(source, scene.truth, 0.05),
                                            scene.observations, options);
    ASSERT_TRUE(report.success);
    const SE3 expected = oracle(scene.truth, scene.observations,
                                std::vector<char>(scene.observations.size(), 1), std::sqrt(6.5));
    EXPECT_LT(translation_distance(report.world_from_camera, expected), 1e-4);
    EXPECT_LT(rotation_angle(report.world_from_camera, expected), 1e-4);
  }
}

TEST(PoseOptimizer, SetsOutliersAside) {
  SampleSource source(4);
  for (int i = 0; i < 20; ++i) {
    const PoseScene scene = make_scene(source, 200, 0.4, 0.8);
    const PoseReport report =
        optimize_pose(test_camera(), nearby(source, scene.truth, 0.03), scene.observations, {});
    ASSERT_TRUE(report.success);
    EXPECT_LT(translation_distance(report.world_from_camera, scene.truth), 0.02);
    int wrong = 0;
    int lost = 0;
    int count = 0;
    for (std::size_t k = 0; k < scene.outlier.size(); ++k) {
      count += report.inlier[k];
      if (report.inlier[k] != 0 && scene.outlier[k] != 0) ++wrong;
      if (report.inlier[k] == 0 && scene.outlier[k] == 0) ++lost;
    }
    EXPECT_EQ(count, report.inliers);
    EXPECT_LE(wrong, 2);
    EXPECT_LE(lost, 10);
  }
}

TEST(PoseOptimizer, InformationIsTheInverseCovarianceOfThePose) {
  // Squared Mahalanobis distances of many noisy solutions average to the six degrees of freedom.
  SampleSource source(5);
  const PoseScene clean = make_scene(source, 80, 0.0, 0.0);
  PoseOptimizerOptions options;
  options.chi2_pixel = options.chi2_depth = 100.0;
  double sum = 0.0;
  constexpr int kRounds = 400;
  for (int i = 0; i < kRounds; ++i) {
    std::vector<PoseObservation> noisy = clean.observations;
    for (PoseObservation& o : noisy) {
      const double nu = o.measured.sigma * source.normal();
      o.measured.pixel += Eigen::Vector2d(nu, o.measured.sigma * source.normal());
      // Disparity as measured from u: the noise of the right column is independent of u.
      if (o.measured.has_disparity())
        o.measured.disparity += nu - o.measured.sigma * source.normal();
    }
    const PoseReport report = optimize_pose(test_camera(), clean.truth, noisy, options);
    ASSERT_TRUE(report.success);
    const Vector6d error = (report.world_from_camera.inverse() * clean.truth).log();
    sum += error.dot(report.information * error);
    EXPECT_LT((report.information - report.information.transpose()).norm(),
              1e-12 * report.information.norm());
  }
  EXPECT_NEAR(sum / kRounds, 6.0, 0.6);
}

// Whatever deviations were assumed: the residuals say how noisy the image is.
TEST(PoseOptimizer, CovarianceFitsTheErrorWhateverTheNoise) {
  SampleSource source(15);
  for (const double noise : {0.3, 1.0, 2.0}) {
    const PoseScene clean = make_scene(source, 80, 0.0, 0.0);
    PoseOptimizerOptions options;
    options.chi2_pixel = options.chi2_depth = 100.0;
    double sum = 0.0;
    double along = 0.0;  // of each direction by itself
    constexpr int kRounds = 300;
    for (int i = 0; i < kRounds; ++i) {
      std::vector<PoseObservation> noisy = clean.observations;
      for (PoseObservation& o : noisy) {
        const double nu = noise * o.measured.sigma * source.normal();
        o.measured.pixel += Eigen::Vector2d(nu, noise * o.measured.sigma * source.normal());
        if (o.measured.has_disparity()) {
          o.measured.disparity += nu - noise * o.measured.sigma * source.normal();
        }
      }
      const PoseReport report = optimize_pose(test_camera(), clean.truth, noisy, options);
      ASSERT_TRUE(report.success);
      const auto covariance = pose_covariance(report.information, report.variance_factor);
      ASSERT_TRUE(covariance);
      EXPECT_EQ(*covariance, covariance->transpose());
      const Vector6d error = (report.world_from_camera.inverse() * clean.truth).log();
      sum += error.dot(covariance->ldlt().solve(error));
      along += (error.array().square() / covariance->diagonal().array()).mean();
    }
    EXPECT_NEAR(sum / kRounds, 6.0, 0.9) << noise;
    EXPECT_NEAR(along / kRounds, 1.0, 0.2) << noise;
  }
}

TEST(PoseOptimizer, ThereIsNoCovarianceWhereADirectionIsOpen) {
  EXPECT_FALSE(pose_covariance(Matrix6d::Zero(), 1.0));
  Matrix6d open = Matrix6d::Identity();
  open(2, 2) = 0.0;
  EXPECT_FALSE(pose_covariance(open, 1.0));
  EXPECT_FALSE(pose_covariance(Matrix6d::Identity(), 0.0));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(pose_covariance(nan * Matrix6d::Identity(), 1.0));
  EXPECT_TRUE(pose_covariance(Matrix6d::Identity(), 2.0)->isApprox(2.0 * Matrix6d::Identity()));
}

TEST(PoseOptimizer, UsesDepthWhereThereIsOne) {
  // Three pixels alone leave depth weak; with disparity the pose of few points is exact.
  SampleSource source(6);
  PoseScene scene = make_scene(source, 8, 0.0, 0.0);
  for (PoseObservation& o : scene.observations) {
    o.measured.disparity = test_camera().bf() / (scene.truth.inverse() * o.point_in_world).z();
  }
  scene.observations[2].measured.disparity *= 3.0;  // right pixel, wrong depth
  const PoseReport report =
      optimize_pose(test_camera(), nearby(source, scene.truth, 0.02), scene.observations, {});
  ASSERT_TRUE(report.success);
  EXPECT_EQ(report.inlier[2], 0);
  EXPECT_EQ(report.inliers, 7);
}

TEST(PoseOptimizer, CountsPointsBehindTheCameraAsOutliers) {
  SampleSource source(7);
  PoseScene scene = make_scene(source, 50, 0.0, 0.5);
  PoseObservation& o = scene.observations[10];
  o.point_in_world = scene.truth * Eigen::Vector3d(-0.1, 0.1, -1.0);
  o.measured.pixel = test_camera().project({-0.1, 0.1, -1.0});
  o.measured.disparity = 0.0;
  const PoseReport report =
      optimize_pose(test_camera(), nearby(source, scene.truth, 0.03), scene.observations, {});
  ASSERT_TRUE(report.success);
  EXPECT_EQ(report.inlier[10], 0);
  EXPECT_LT(translation_distance(report.world_from_camera, scene.truth), 0.02);
}

TEST(PoseOptimizer, SetsValuesThatAreNotFiniteAside) {
  SampleSource source(8);
  PoseScene scene = make_scene(source, 50, 0.0, 0.5);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  scene.observations[0].measured.pixel.x() = nan;
  scene.observations[1].point_in_world.z() = std::numeric_limits<double>::infinity();
  scene.observations[2].measured.disparity = nan;
  scene.observations[3].measured.sigma = 0.0;
  scene.observations[4].measured.sigma = nan;
  const PoseReport report =
      optimize_pose(test_camera(), nearby(source, scene.truth, 0.03), scene.observations, {});
  ASSERT_TRUE(report.success);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(report.inlier[i], 0) << i;
  EXPECT_TRUE(report.information.allFinite());
  EXPECT_LT(translation_distance(report.world_from_camera, scene.truth), 0.02);
}

TEST(PoseOptimizer, KeepsTheStartOnFailure) {
  SampleSource source(9);
  const PoseScene scene = make_scene(source, 5, 0.0, 0.0);
  const SE3 start = nearby(source, scene.truth, 0.1);
  const PoseReport few = optimize_pose(test_camera(), start, scene.observations, {});
  EXPECT_FALSE(few.success);
  EXPECT_EQ(few.world_from_camera.matrix(), start.matrix());

  const PoseReport none = optimize_pose(test_camera(), start, {}, {});
  EXPECT_FALSE(none.success);
  EXPECT_EQ(none.world_from_camera.matrix(), start.matrix());

  const SE3 broken(Eigen::Quaterniond::Identity(),
                   {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0});
  EXPECT_FALSE(optimize_pose(test_camera(), broken, scene.observations, {}).success);
}

TEST(PoseOptimizer, FailsWhenNothingAgrees) {
  SampleSource source(10);
  const PoseScene scene = make_scene(source, 60, 1.0, 0.0);
  PoseOptimizerOptions options;
  options.min_inliers = 15;
  EXPECT_FALSE(optimize_pose(test_camera(), scene.truth, scene.observations, options).success);
}

TEST(PoseOptimizer, GivesTheSameAnswerTwice) {
  SampleSource source(11);
  const PoseScene scene = make_scene(source, 100, 0.3, 1.0);
  const SE3 start = nearby(source, scene.truth, 0.05);
  const PoseReport a = optimize_pose(test_camera(), start, scene.observations, {});
  const PoseReport b = optimize_pose(test_camera(), start, scene.observations, {});
  EXPECT_EQ(a.world_from_camera.matrix(), b.world_from_camera.matrix());
  EXPECT_EQ(a.information, b.information);
}

TEST(PoseOptimizer, OptionsHaveValidDefaults) {
  EXPECT_NO_THROW(validate_options("pose", PoseOptimizerOptions()));
}

}  // namespace
}  // namespace dxslam
