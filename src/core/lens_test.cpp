// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/lens.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <set>

#include "core/camera.h"
#include "core/error.h"

namespace dxslam {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// Real calibrations of each model: a TUM Kinect, an Azure Kinect, a RealSense T265 and the lens of
// the double sphere paper's dataset (TUM VI).
std::vector<Lens> real_lenses() {
  return {{&kRadialTangential, {0.262383, -0.953104, -0.005358, 0.002628, 1.163314}},
          {&kRational, {0.45, -2.6, 0.0006, -0.0002, 1.55, 0.33, -2.42, 1.48}},
          {&kKannalaBrandt, {-0.0072, 0.0405, -0.0375, 0.0063}},
          {&kDoubleSphere, {-0.2, 0.59}}};
}

TEST(Lens, TheTableNamesEachModelOnce) {
  std::set<std::string> names;
  for (const LensModel* model : lens_models()) {
    EXPECT_TRUE(names.insert(model->name).second) << model->name;
    EXPECT_EQ(find_lens_model(model->name), model);
    EXPECT_GT(model->parameter_count(), 0U);
  }
  EXPECT_EQ(names.size(), real_lenses().size());
  EXPECT_EQ(find_lens_model("pinhole"), nullptr);
  EXPECT_TRUE(Lens().is_ideal());
  EXPECT_FALSE((Lens{&kKannalaBrandt, {}}.is_ideal()));
}

TEST(Lens, UndistortInvertsDistort) {
  for (const Lens& lens : real_lenses()) {
    const double widest = lens.model->is_fisheye ? 3.0 : 0.7;
    for (int i = 0; i <= 20; ++i) {
      const double r = widest * i / 20.0;
      const Eigen::Vector2d ideal(r * std::cos(0.7 * i), r * std::sin(0.7 * i));
      const Eigen::Vector2d distorted = lens.model->distort(lens.parameters, ideal, nullptr);
      const auto again = lens.model->undistort(lens.parameters, distorted);
      ASSERT_TRUE(again) << lens.model->name;
      EXPECT_LT((*again - ideal).norm(), 1e-8) << lens.model->name << " " << ideal.transpose();
    }
  }
}

TEST(Lens, TheJacobianIsTheSlopeOfDistort) {
  for (const Lens& lens : real_lenses()) {
    for (const Eigen::Vector2d& ideal :
         {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(0.4, -0.3), Eigen::Vector2d(-0.1, 0.6)}) {
      Eigen::Matrix2d jacobian;
      lens.model->distort(lens.parameters, ideal, &jacobian);
      for (int k = 0; k < 2; ++k) {
        const Eigen::Vector2d step = 1e-6 * Eigen::Vector2d::Unit(k);
        const Eigen::Vector2d slope =
            (lens.model->distort(lens.parameters, ideal + step, nullptr) -
             lens.model->distort(lens.parameters, ideal - step, nullptr)) /
            2e-6;
        EXPECT_LT((jacobian.col(k) - slope).norm(), 1e-7) << lens.model->name;
      }
    }
  }
}

// An independent implementation of three of the four.
TEST(Lens, BendsAsOpenCvSays) {
  for (const Lens& lens : real_lenses()) {
    if (lens.model == &kDoubleSphere) continue;
    const std::vector<double> coefficients(
        lens.parameters.begin(),
        lens.parameters.begin() + static_cast<std::ptrdiff_t>(lens.model->parameter_count()));
    for (const Eigen::Vector2d& ideal : {Eigen::Vector2d(0.3, -0.2), Eigen::Vector2d(-0.5, 0.4)}) {
      std::vector<cv::Point2d> seen;
      const std::vector<cv::Point3d> point = {{ideal.x(), ideal.y(), 1.0}};
      const cv::Vec3d zero(0.0, 0.0, 0.0);
      const cv::Matx33d unit = cv::Matx33d::eye();
      if (lens.model == &kKannalaBrandt) {
        cv::fisheye::projectPoints(point, seen, zero, zero, unit, coefficients);
      } else {
        cv::projectPoints(point, zero, zero, unit, coefficients, seen);
      }
      const Eigen::Vector2d expected(seen[0].x, seen[0].y);
      EXPECT_LT((lens.model->distort(lens.parameters, ideal, nullptr) - expected).norm(), 1e-9)
          << lens.model->name;
    }
  }
}

// By the definition: on a sphere, on a second one xi ahead, then from alpha / (1 - alpha) ahead.
TEST(Lens, DoubleSphereIsTwoProjections) {
  const double xi = -0.2;
  const double alpha = 0.59;
  const Eigen::Vector3d point(0.5, -0.4, 1.0);
  const Eigen::Vector3d first = point.normalized();
  const Eigen::Vector3d second = (first + Eigen::Vector3d(0.0, 0.0, xi)).normalized();
  const double ahead = alpha / (1.0 - alpha);
  const Eigen::Vector2d seen = second.head<2>() / (second.z() + ahead);
  // The model's focal length is that of a lens without the shift.
  const Eigen::Vector2d expected = seen / (1.0 - alpha);
  const Eigen::Vector2d distorted =
      kDoubleSphere.distort({xi, alpha}, point.head<2>() / point.z(), nullptr);
  EXPECT_LT((distorted - expected).norm(), 1e-12);
}

// Fitted to the angles of an image, a polynomial may turn down anywhere beyond them.
TEST(Lens, KannalaBrandtIsUndoneUpToWhereItTurns) {
  const Lens::Parameters turning = {0.34, -0.38, 0.48, -0.27};  // turns at 1.05 rad
  for (double angle = 0.05; angle < 1.0; angle += 0.05) {
    const Eigen::Vector2d ideal(std::tan(angle), 0.0);
    const auto again =
        kKannalaBrandt.undistort(turning, kKannalaBrandt.distort(turning, ideal, nullptr));
    ASSERT_TRUE(again) << angle;
    EXPECT_LT((*again - ideal).norm(), 1e-8) << angle;
  }
  EXPECT_FALSE(kKannalaBrandt.undistort(turning, {1.3, 0.0}));
  EXPECT_FALSE(kKannalaBrandt.undistort({-100.0, 100.0}, {0.3, 0.0})) << "folds at 3 degrees";
}

Camera fisheye_camera() {
  Camera camera;
  camera.width = 848;
  camera.height = 800;
  camera.fx = camera.fy = 286.0;
  camera.cx = 419.0;
  camera.cy = 398.0;
  camera.lens = {&kKannalaBrandt, {-0.0072, 0.0405, -0.0375, 0.0063}};
  return camera;
}

TEST(FisheyeCamera, UsesDirectionsUpToTheWidestAngle) {
  Camera camera = fisheye_camera();
  camera.prepare("calib.yaml");
  EXPECT_FALSE(camera.undistort({0.0, 0.0})) << "beside the camera";
  const double edge = camera.fx * Camera::kWidestAngle * 3.14159265 / 180.0;
  EXPECT_TRUE(camera.undistort({camera.cx + 0.95 * edge, camera.cy}));
  EXPECT_FALSE(camera.undistort({camera.cx + 1.1 * edge, camera.cy}));
  EXPECT_GT(camera.view().right, 3.0 * camera.fx);
  const auto seen = camera.project_into_view({2.0, 0.5, 1.0});
  ASSERT_TRUE(seen);
  const auto again = camera.undistort(camera.distort(*seen));
  ASSERT_TRUE(again);
  EXPECT_LT((*again - *seen).norm(), 1e-6);
}

TEST(FisheyeCamera, SaysHowLongAPixelIs) {
  Camera camera = fisheye_camera();
  camera.prepare("calib.yaml");
  EXPECT_NEAR(camera.stretch({camera.cx, camera.cy}), 1.0, 1e-9);
  const Eigen::Vector2d raw(camera.cx + 300.0, camera.cy + 100.0);
  const Eigen::Vector2d pixel = camera.undistort(raw).value();
  const Eigen::Vector2d right = *camera.undistort(raw + Eigen::Vector2d(0.01, 0.0)) - pixel;
  const Eigen::Vector2d down = *camera.undistort(raw + Eigen::Vector2d(0.0, 0.01)) - pixel;
  const double area = std::abs(right.x() * down.y() - right.y() * down.x()) / 1e-4;
  EXPECT_NEAR(camera.stretch(pixel), std::sqrt(area), 1e-3);
  EXPECT_GT(camera.stretch(pixel), 2.0);
}

TEST(FisheyeCamera, ThatSeesAlmostNothingAheadIsRefused) {
  Camera camera = fisheye_camera();
  camera.fx = camera.fy = 60.0;  // the image is 14 half turns wide
  try {
    camera.prepare("calib.yaml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("calib.yaml: the distortion (kannala_brandt)"),
                                    HasSubstr("within 75 degrees")));
  }
}

}  // namespace
}  // namespace dxslam
