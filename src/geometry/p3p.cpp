// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "geometry/p3p.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace dxslam {
namespace {

using Triangle = std::array<Eigen::Vector3d, 3>;

constexpr double kMinSine2 = 1e-12;  // squared sine below which three points are a line

// Right-handed orthonormal frame: x along the first edge, z normal to the triangle.
Eigen::Matrix3d triangle_frame(const Triangle& t) {
  const Eigen::Vector3d x = (t[1] - t[0]).normalized();
  const Eigen::Vector3d z = x.cross(t[2] - t[0]).normalized();
  Eigen::Matrix3d frame;
  frame << x, z.cross(x), z;
  return frame;
}

// One real root of c3 g^3 + c2 g^2 + c1 g + c0 with c3 not 0, polished by Newton's method.
double real_cubic_root(double c3, double c2, double c1, double c0) {
  const double a = c2 / c3;
  const double b = c1 / c3;
  const double c = c0 / c3;
  const double shift = a / 3.0;
  const double p = b - a * shift;  // depressed: y^3 + p y + q
  const double q = 2.0 * shift * shift * shift - shift * b + c;
  const double discriminant = q * q / 4.0 + p * p * p / 27.0;
  double y = 0.0;
  if (discriminant >= 0.0) {
    // The summand without cancellation first, the other by their product -p / 3.
    const double u = std::cbrt(-0.5 * q - std::copysign(std::sqrt(discriminant), q));
    y = u != 0.0 ? u - p / (3.0 * u) : 0.0;
  } else {
    const double radius = std::sqrt(-p / 3.0);
    const double cosine = std::clamp(-0.5 * q / (radius * radius * radius), -1.0, 1.0);
    y = 2.0 * radius * std::cos(std::acos(cosine) / 3.0);
  }
  double g = y - shift;
  for (int i = 0; i < 3; ++i) {
    const double value = ((g + a) * g + b) * g + c;
    const double slope = (3.0 * g + 2.0 * a) * g + b;
    if (!(std::abs(slope) > 1e-300)) break;
    g -= value / slope;
  }
  return g;
}

Eigen::Matrix3d adjugate(const Eigen::Matrix3d& m) {
  Eigen::Matrix3d result;
  result << m.row(1).cross(m.row(2)), m.row(2).cross(m.row(0)), m.row(0).cross(m.row(1));
  return result.transpose();
}

/// Distances s along unit rays obey s_i^2 + s_j^2 - 2 cos_ij s_i s_j = side_ij^2.
class DistanceSolver {
 public:
  DistanceSolver(const Triangle& points, const Triangle& unit_rays) {
    for (int k = 0; k < 3; ++k) {
      const int i = k;
      const int j = (k + 1) % 3;
      side2_[k] = (points[i] - points[j]).squaredNorm();
      form_[k].setZero();
      form_[k](i, i) = form_[k](j, j) = 1.0;
      form_[k](i, j) = form_[k](j, i) = -unit_rays[i].dot(unit_rays[j]);
    }
  }

  /// Calls visit(distances) for each positive solution.
  template <class Visitor>
  void solve(Visitor visit) const {
    // Two conics through all solutions span a pencil; the cubic for its degenerate members is led
    // by the determinant of one member, which symmetry can make vanish, but not for all four here.
    const Eigen::Matrix3d a = (form_[0] * side2_[1] - form_[1] * side2_[0]).normalized();
    const Eigen::Matrix3d b = (form_[2] * side2_[1] - form_[1] * side2_[2]).normalized();
    const std::array<Eigen::Matrix3d, 4> members = {b, a, a + b, a - b};
    const auto d2_at = std::max_element(members.begin(), members.end(), [](auto& x, auto& y) {
      return std::abs(x.determinant()) < std::abs(y.determinant());
    });
    const Eigen::Matrix3d& d2 = *d2_at;
    const Eigen::Matrix3d& d1 = d2_at == members.begin() + 1 ? members[0] : members[1];
    const double c3 = d2.determinant();
    const double c2 = (adjugate(d2) * d1).trace();
    const double c1 = (adjugate(d1) * d2).trace();
    const double gamma = real_cubic_root(c3, c2, c1, d1.determinant());
    if (!std::isfinite(gamma)) return;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(d1 + gamma * d2);
    // Ascending: a pair of lines has signature (-, 0, +).
    const Eigen::Vector3d& values = eigen.eigenvalues();
    if (!(values(0) < 0.0) || !(values(2) > 0.0)) return;
    const double ratio = std::sqrt(-values(0) / values(2));
    for (const double s : {ratio, -ratio}) {
      // The line e2 . x = s e0 . x is spanned by e1 and e0 + s e2.
      const Eigen::Vector3d w = eigen.eigenvectors().col(0) + s * eigen.eigenvectors().col(2);
      intersect(d2, eigen.eigenvectors().col(1), w, visit);
    }
  }

 private:
  // Points x = alpha a + beta b of the conic x^T d x = 0.
  template <class Visitor>
  void intersect(const Eigen::Matrix3d& d, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                 Visitor& visit) const {
    const double aa = a.dot(d * a);
    const double ab = a.dot(d * b);
    const double bb = b.dot(d * b);
    const double discriminant = ab * ab - aa * bb;
    if (!(discriminant >= 0.0)) return;
    // Both roots of aa alpha^2 + 2 ab alpha beta + bb beta^2 without cancellation.
    const double h = -ab - std::copysign(std::sqrt(discriminant), ab);
    offer(h * a + aa * b, visit);
    offer(bb * a + h * b, visit);
  }

  template <class Visitor>
  void offer(Eigen::Vector3d s, Visitor& visit) const {
    const double scale2 = s.dot((form_[0] + form_[1] + form_[2]) * s);
    if (!(scale2 > 0.0)) return;
    s *= std::sqrt((side2_[0] + side2_[1] + side2_[2]) / scale2);
    if (s.sum() < 0.0) s = -s;
    polish(s);
    if (s.allFinite() && s.minCoeff() > 0.0) visit(s);
  }

  void polish(Eigen::Vector3d& s) const {
    for (int iteration = 0; iteration < 2; ++iteration) {
      Eigen::Vector3d residual;
      Eigen::Matrix3d jacobian;
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d gradient = form_[k] * s;
        residual(k) = s.dot(gradient) - side2_[k];
        jacobian.row(k) = 2.0 * gradient.transpose();
      }
      const Eigen::Vector3d step = jacobian.inverse() * residual;
      if (!step.allFinite() || step.norm() > 0.1 * s.norm()) return;
      s -= step;
    }
  }

  std::array<double, 3> side2_{};
  std::array<Eigen::Matrix3d, 3> form_;
};

}  // namespace

bool spans_plane(const Triangle& points) {
  const Eigen::Vector3d a = points[1] - points[0];
  const Eigen::Vector3d b = points[2] - points[0];
  return a.cross(b).squaredNorm() > kMinSine2 * a.squaredNorm() * b.squaredNorm();
}

SE3 align_triangles(const Triangle& source, const Triangle& target) {
  const Eigen::Matrix3d rotation = triangle_frame(target) * triangle_frame(source).transpose();
  const Eigen::Quaterniond q(rotation);
  return {q, target[0] - q * source[0]};
}

P3pSolutions solve_p3p(const Triangle& points_in_world, const Triangle& rays) {
  P3pSolutions solutions;
  if (!spans_plane(points_in_world)) return solutions;
  for (const Eigen::Vector3d& ray : rays) {
    if (!(ray.squaredNorm() > 0.0)) return solutions;
  }
  const Triangle unit = {rays[0].normalized(), rays[1].normalized(), rays[2].normalized()};
  DistanceSolver(points_in_world, unit).solve([&](const Eigen::Vector3d& s) {
    const Triangle in_camera = {s(0) * unit[0], s(1) * unit[1], s(2) * unit[2]};
    const SE3 pose = align_triangles(points_in_world, in_camera);
    if (!pose.translation().allFinite() || !pose.rotation().coeffs().allFinite()) return;
    solutions.camera_from_world[static_cast<std::size_t>(solutions.count)] = pose;
    ++solutions.count;
  });
  return solutions;
}

}  // namespace dxslam
