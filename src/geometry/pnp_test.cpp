// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "geometry/pnp.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"
#include "core/options.h"
#include "geometry/geometry_scene.h"

namespace dxslam {
namespace {

enum class Depths { kNone, kSome, kAll };

std::vector<float> chosen(const ViewScene& scene, Depths which) {
  std::vector<float> depths;
  if (which != Depths::kNone) depths = scene.depths;
  if (which == Depths::kSome) {
    for (std::size_t i = 0; i < depths.size(); i += 2) depths[i] = 0.0F;
  }
  return depths;
}

class PnpTest : public testing::TestWithParam<Depths> {
 protected:
  std::optional<PnpReport> solve(const ViewScene& scene, const PnpOptions& options = {}) const {
    return solve_pnp(test_camera(), scene.points, scene.pixels, chosen(scene, GetParam()), options);
  }
};

TEST_P(PnpTest, IsExactWithoutNoise) {
  SampleSource source(1);
  for (int round = 0; round < 20; ++round) {
    const ViewScene scene = make_view_scene(source, 30, 0.0, 0.0);
    const auto report = solve(scene);
    ASSERT_TRUE(report);
    EXPECT_EQ(report->inliers, 30);
    EXPECT_LT(translation_distance(report->world_from_camera, scene.world_from_camera), 1e-7);
    EXPECT_LT(rotation_angle(report->world_from_camera, scene.world_from_camera), 1e-7);
  }
}

TEST_P(PnpTest, SurvivesSixtyPercentOutliers) {
  SampleSource source(2);
  for (int round = 0; round < 30; ++round) {
    const ViewScene scene = make_view_scene(source, 100, 0.6, 1.0);
    const auto report = solve(scene);
    ASSERT_TRUE(report);
    EXPECT_LT(translation_distance(report->world_from_camera, scene.world_from_camera), 0.03);
    EXPECT_LT(rotation_angle(report->world_from_camera, scene.world_from_camera), 0.01);
    int wrong = 0;
    int good = 0;
    int clean = 0;
    for (std::size_t i = 0; i < scene.outlier.size(); ++i) {
      if (scene.outlier[i] == 0) ++clean;
      if (report->inlier[i] != 0) ++(scene.outlier[i] != 0 ? wrong : good);
    }
    EXPECT_EQ(wrong + good, report->inliers);
    EXPECT_LE(wrong, 3);
    EXPECT_GE(good, 9 * clean / 10);
  }
}

TEST_P(PnpTest, GivesTheSameAnswerTwice) {
  SampleSource source(3);
  const ViewScene scene = make_view_scene(source, 80, 0.5, 1.0);
  const auto a = solve(scene);
  const auto b = solve(scene);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->world_from_camera.matrix(), b->world_from_camera.matrix());
  EXPECT_EQ(a->inlier, b->inlier);
}

TEST_P(PnpTest, FailsOnPureOutliers) {
  SampleSource source(4);
  for (int round = 0; round < 5; ++round) {
    EXPECT_FALSE(solve(make_view_scene(source, 100, 1.0, 1.0)));
  }
}

TEST_P(PnpTest, RefusesTooFewCorrespondences) {
  SampleSource source(5);
  PnpOptions options;
  options.min_inliers = 4;
  EXPECT_FALSE(solve(make_view_scene(source, 0, 0.0, 0.0), options));
  EXPECT_FALSE(solve(make_view_scene(source, 3, 0.0, 0.0), options));
  EXPECT_TRUE(solve(make_view_scene(source, 4, 0.0, 0.0), options));
  options.min_inliers = 20;
  EXPECT_FALSE(solve(make_view_scene(source, 19, 0.0, 0.0), options));
}

TEST_P(PnpTest, FailsOnPointsInALine) {
  SampleSource source(6);
  ViewScene scene = make_view_scene(source, 30, 0.0, 0.0);
  const SE3 camera_from_world = scene.world_from_camera.inverse();
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    const Eigen::Vector3d p(-0.5 + 0.03 * static_cast<double>(i), 0.1, 2.0);
    scene.points[i] = scene.world_from_camera * p;
    scene.pixels[i] = test_camera().project(camera_from_world * scene.points[i]);
    scene.depths[i] = 2.0F;
  }
  EXPECT_FALSE(solve(scene));
}

TEST_P(PnpTest, SetsAsideCorrespondencesThatAreNotFinite) {
  SampleSource source(7);
  ViewScene scene = make_view_scene(source, 40, 0.0, 0.5);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  scene.points[3].z() = nan;
  scene.pixels[5].x() = std::numeric_limits<double>::infinity();
  scene.depths[8] = std::numeric_limits<float>::quiet_NaN();
  scene.depths[9] = -1.0F;
  const auto report = solve(scene);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->inlier[3], 0);
  EXPECT_EQ(report->inlier[5], 0);
  EXPECT_EQ(report->inlier[8], 1);
  EXPECT_LT(translation_distance(report->world_from_camera, scene.world_from_camera), 0.03);

  for (Eigen::Vector3d& p : scene.points) p.x() = nan;
  EXPECT_FALSE(solve(scene));
}

TEST_P(PnpTest, DoesNotHangOnRepeatedCorrespondences) {
  SampleSource source(8);
  ViewScene scene = make_view_scene(source, 1, 0.0, 0.0);
  scene.points.resize(20, scene.points[0]);
  scene.pixels.resize(20, scene.pixels[0]);
  scene.depths.resize(20, scene.depths[0]);
  EXPECT_FALSE(solve(scene));
}

INSTANTIATE_TEST_SUITE_P(Depth, PnpTest,
                         testing::Values(Depths::kNone, Depths::kSome, Depths::kAll));

TEST(Pnp, CountsAPointAtTheWrongDepthAsAnOutlier) {
  SampleSource source(9);
  ViewScene scene = make_view_scene(source, 40, 0.0, 0.0);
  scene.depths[4] *= 1.2F;
  scene.depths[6] *= 0.8F;
  scene.depths[7] *= 1.05F;
  const auto report = solve_pnp(test_camera(), scene.points, scene.pixels, scene.depths, {});
  ASSERT_TRUE(report);
  EXPECT_EQ(report->inlier[4], 0);
  EXPECT_EQ(report->inlier[6], 0);
  EXPECT_EQ(report->inlier[7], 1);
  EXPECT_EQ(report->inliers, 38);
}

TEST(Pnp, ThrowsOnSizesThatDoNotFit) {
  SampleSource source(10);
  ViewScene scene = make_view_scene(source, 20, 0.0, 0.0);
  scene.depths.pop_back();
  EXPECT_THROW(solve_pnp(test_camera(), scene.points, scene.pixels, scene.depths, {}),
               ContractError);
  scene.pixels.pop_back();
  EXPECT_THROW(solve_pnp(test_camera(), scene.points, scene.pixels, {}, {}), ContractError);
}

TEST(Pnp, OptionsHaveValidDefaults) {
  EXPECT_NO_THROW(validate_options("pnp", PnpOptions()));
  PnpOptions options;
  options.min_inliers = 3;
  EXPECT_THROW(validate_options("pnp", options), InputError);
}

}  // namespace
}  // namespace dxslam
