// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/recordings/inverse_distortion.h"

#include <gtest/gtest.h>

namespace dxslam {
namespace {

TEST(InverseDistortion, UndoesWhatTheInversePolynomialDoes) {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = 390.0;
  camera.fy = 392.0;
  camera.cx = 322.0;
  camera.cy = 236.0;
  const std::array<double, 5> inverse{-0.055, 0.066, 0.0003, 0.0008, -0.021};  // of a D455
  EXPECT_LT(set_inverse_distortion(inverse, camera), 0.1);
  camera.prepare("test");
  // The polynomial itself is what distort() does with these coefficients.
  Camera polynomial = camera;
  std::copy(inverse.begin(), inverse.end(), polynomial.lens.parameters.begin());
  for (const Eigen::Vector2d& raw : {Eigen::Vector2d(0, 0), {639, 0}, {100, 479}, {400, 200}}) {
    const Eigen::Vector2d ideal = polynomial.distort(raw);
    EXPECT_LT((camera.distort(ideal) - raw).norm(), 0.1);
    EXPECT_LT((*camera.undistort(raw) - ideal).norm(), 0.1);
  }
}

}  // namespace
}  // namespace dxslam
