// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "geometry/triangulation.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <cmath>

#include "geometry/reprojection.h"

namespace dxslam {
namespace {

struct TwoViews {
  const PixelView& a;
  const PixelView& b;
  SE3 b_from_a;
  Eigen::Matrix3d rotation;  // of b_from_a
};

bool in_front(const TwoViews& views, const Eigen::Vector3d& p) {
  return p.allFinite() && p.z() > kMinProjectionDepth &&
         (views.b_from_a * p).z() > kMinProjectionDepth;
}

double squared_error(const TwoViews& views, const Eigen::Vector3d& p) {
  return views.a.camera.squared_error(p, views.a.pixel) +
         views.b.camera.squared_error(views.b_from_a * p, views.b.pixel);
}

// Linear triangulation in frame a: x * (row 3) - (row 1) = 0 and the same for y, in both views.
Eigen::Vector3d linear_point(const TwoViews& views, const Eigen::Vector3d& ray_a,
                             const Eigen::Vector3d& ray_b) {
  const Eigen::Vector3d& t = views.b_from_a.translation();
  Eigen::Matrix<double, 4, 3> a;
  a << -1.0, 0.0, ray_a.x(),  //
      0.0, -1.0, ray_a.y(),   //
      ray_b.x() * views.rotation.row(2) - views.rotation.row(0),
      ray_b.y() * views.rotation.row(2) - views.rotation.row(1);
  const Eigen::Vector4d b(0.0, 0.0, t.x() - ray_b.x() * t.z(), t.y() - ray_b.y() * t.z());
  return a.householderQr().solve(b);
}

Eigen::Vector3d gauss_newton_step(const TwoViews& views, const Eigen::Vector3d& p) {
  const Eigen::Vector3d q = views.b_from_a * p;
  Eigen::Matrix<double, 4, 3> jacobian;
  jacobian.topRows<2>() = project_stereo_jacobian(views.a.camera, p).topRows<2>();
  jacobian.bottomRows<2>() =
      project_stereo_jacobian(views.b.camera, q).topRows<2>() * views.rotation;
  Eigen::Vector4d residual;
  residual << views.a.camera.project(p) - views.a.pixel, views.b.camera.project(q) - views.b.pixel;
  const Eigen::Matrix3d hessian = jacobian.transpose() * jacobian;
  return p - hessian.ldlt().solve(jacobian.transpose() * residual);
}

}  // namespace

std::optional<Eigen::Vector3d> triangulate(const PixelView& a, const PixelView& b,
                                           double min_parallax) {
  const SE3 b_from_a = b.world_from_camera.inverse() * a.world_from_camera;
  const TwoViews views{a, b, b_from_a, b_from_a.rotation().toRotationMatrix()};
  const Eigen::Vector3d ray_a = a.camera.unproject(a.pixel, 1.0);
  const Eigen::Vector3d ray_b = b.camera.unproject(b.pixel, 1.0);
  const Eigen::Vector3d turned = views.rotation * ray_a;
  // atan2 of sine and cosine: exact for the tiny angles that matter here.
  const double parallax = std::atan2(turned.cross(ray_b).norm(), turned.dot(ray_b));
  if (!(parallax > min_parallax)) return std::nullopt;

  Eigen::Vector3d point = linear_point(views, ray_a, ray_b);
  if (!in_front(views, point)) return std::nullopt;
  const Eigen::Vector3d refined = gauss_newton_step(views, point);
  if (in_front(views, refined) && squared_error(views, refined) < squared_error(views, point)) {
    point = refined;
  }
  return a.world_from_camera * point;
}

}  // namespace dxslam
