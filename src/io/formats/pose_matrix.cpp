// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/formats/pose_matrix.h"

#include <fmt/format.h>

#include "core/error.h"

namespace dxslam {

SE3 pose_from_row_major(const double (&values)[16], const std::string& where) {
  Eigen::Matrix4d matrix;
  for (int i = 0; i < 16; ++i) matrix(i / 4, i % 4) = values[i];
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  const double skewness =
      (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (rotation.determinant() < 0.0 && skewness <= 0.01) {
    throw InputError(fmt::format(
        "{}: rotation part mirrors (its determinant is -1), expected a pose of a right-handed "
        "camera",
        where));
  }
  if (!(skewness <= 0.01)) {
    throw InputError(fmt::format("{}: rotation part is off orthonormal by {:.3g}, expected a pose",
                                 where, skewness));
  }
  if ((matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > 1e-6) {
    throw InputError(fmt::format("{}: last row of the pose is not 0 0 0 1", where));
  }
  const Eigen::Vector3d position = matrix.topRightCorner<3, 1>();
  require_near(position, where);
  return {Eigen::Quaterniond(rotation), position};
}

void require_near(const Eigen::Vector3d& position, const std::string& where) {
  constexpr double kFarthest = 1e12;  // the solar system, in metres
  const double farthest = position.cwiseAbs().maxCoeff();
  if (farthest <= kFarthest) return;
  throw InputError(
      fmt::format("{}: position has a coordinate of {:.3g}, expected metres, at most "
                  "{:g}",
                  where, farthest, kFarthest));
}

}  // namespace dxslam
