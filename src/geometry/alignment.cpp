// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "geometry/alignment.h"

#include <Eigen/SVD>
#include <cmath>

#include "core/error.h"

namespace dxslam {
namespace {

// A spread across the line below this share of the spread along it is rounding, not shape.
constexpr double kLineRatio = 1e-6;

struct Moments {
  Eigen::Vector3d source_mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d source_scatter = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();  // target * source^T
};

Moments moments(const std::vector<Eigen::Vector3d>& source,
                const std::vector<Eigen::Vector3d>& target) {
  Moments m;
  for (const Eigen::Vector3d& p : source) m.source_mean += p;
  for (const Eigen::Vector3d& p : target) m.target_mean += p;
  m.source_mean /= static_cast<double>(source.size());
  m.target_mean /= static_cast<double>(target.size());
  for (std::size_t i = 0; i < source.size(); ++i) {
    const Eigen::Vector3d s = source[i] - m.source_mean;
    m.source_scatter += s * s.transpose();
    m.cross += (target[i] - m.target_mean) * s.transpose();
  }
  return m;
}

}  // namespace

std::optional<Sim3> align_points(const std::vector<Eigen::Vector3d>& source,
                                 const std::vector<Eigen::Vector3d>& target, bool with_scale) {
  require(source.size() == target.size(), "align_points needs as many source as target points");
  if (source.size() < 3) return std::nullopt;
  const Moments m = moments(source, target);
  if (!m.cross.allFinite() || !m.source_scatter.allFinite()) return std::nullopt;

  const Eigen::JacobiSVD<Eigen::Matrix3d> shape(m.source_scatter);
  const Eigen::Vector3d spread = shape.singularValues().cwiseSqrt();
  if (!(spread(1) > kLineRatio * spread(0))) return std::nullopt;

  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m.cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d& singular = svd.singularValues();
  if (!(singular(1) > kLineRatio * kLineRatio * singular(0))) return std::nullopt;

  // The nearest rotation, never a reflection: flip the weakest axis where the determinant says so.
  const Eigen::Matrix3d& u = svd.matrixU();
  const Eigen::Matrix3d& v = svd.matrixV();
  const double sign = u.determinant() * v.determinant() < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d flip(1.0, 1.0, sign);
  const Eigen::Quaterniond rotation(Eigen::Matrix3d(u * flip.asDiagonal() * v.transpose()));
  const double scale = with_scale ? singular.dot(flip) / m.source_scatter.trace() : 1.0;
  if (!(scale > 0.0) || !std::isfinite(scale)) return std::nullopt;
  return Sim3(scale, rotation, m.target_mean - scale * (rotation * m.source_mean));
}

}  // namespace dxslam
