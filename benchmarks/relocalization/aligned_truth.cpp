// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "aligned_truth.h"

#include <Eigen/Dense>
#include <numbers>

namespace dxslam::benchmark {
namespace {

constexpr int kRounds = 100;

// The rotation nearest to a sum of rotations.
Eigen::Matrix3d mean_rotation(const Eigen::Matrix3d& sum) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1.0, 1.0, (svd.matrixU() * svd.matrixV().transpose()).determinant());
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

}  // namespace

Deviation deviation(const SE3& pose, const SE3& truth) {
  return {translation_distance(pose, truth),
          rotation_angle(pose, truth) * 180.0 / std::numbers::pi};
}

MapAlignment align_poses(const std::vector<PosePair>& pairs, double unit_distance,
                         double unit_angle_degrees) {
  const double by_distance = 1.0 / (unit_distance * unit_distance);
  const double radians = unit_angle_degrees * std::numbers::pi / 180.0;
  const double by_angle = 1.0 / (radians * radians);
  SE3 truth_from_map = align(pairs, Alignment::kSe3).rigid();
  for (int round = 0; round < kRounds; ++round) {  // Gauss-Newton on a left perturbation
    Matrix6d hessian = Matrix6d::Zero();
    Vector6d gradient = Vector6d::Zero();
    for (const PosePair& pair : pairs) {
      const SE3 pose = truth_from_map * pair.estimate.world_from_camera;
      const SE3& truth = pair.truth.world_from_camera;
      Eigen::Matrix<double, 3, 6> shift;
      shift << Eigen::Matrix3d::Identity(), -skew(pose.translation());
      hessian += by_distance * shift.transpose() * shift;
      gradient += by_distance * shift.transpose() * (pose.translation() - truth.translation());
      hessian.bottomRightCorner<3, 3>().diagonal().array() += by_angle;
      gradient.tail<3>() += by_angle * so3_log(pose.rotation() * truth.rotation().conjugate());
    }
    const Vector6d step = hessian.ldlt().solve(-gradient);
    truth_from_map = SE3::exp(step) * truth_from_map;
    if (step.norm() < 1e-10) break;
  }
  return {truth_from_map, SE3()};
}

MapAlignment align_with_camera_offset(const std::vector<PosePair>& pairs) {
  Eigen::Matrix3d world = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d offset = Eigen::Matrix3d::Identity();
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d world_sum = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d offset_sum = Eigen::Matrix3d::Zero();
    for (const PosePair& pair : pairs) {
      const Eigen::Matrix3d t = pair.truth.world_from_camera.rotation().toRotationMatrix();
      const Eigen::Matrix3d e = pair.estimate.world_from_camera.rotation().toRotationMatrix();
      world_sum += t * (e * offset).transpose();
    }
    world = mean_rotation(world_sum);
    for (const PosePair& pair : pairs) {
      const Eigen::Matrix3d t = pair.truth.world_from_camera.rotation().toRotationMatrix();
      const Eigen::Matrix3d e = pair.estimate.world_from_camera.rotation().toRotationMatrix();
      offset_sum += (world * e).transpose() * t;
    }
    offset = mean_rotation(offset_sum);
  }
  // truth position = world * (position + rotation * x) + t, linear in t and x.
  Eigen::MatrixXd a(3 * pairs.size(), 6);
  Eigen::VectorXd b(3 * pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const SE3& estimate = pairs[i].estimate.world_from_camera;
    const auto row = static_cast<Eigen::Index>(3 * i);
    a.block<3, 3>(row, 0).setIdentity();
    a.block<3, 3>(row, 3) = world * estimate.rotation().toRotationMatrix();
    b.segment<3>(row) =
        pairs[i].truth.world_from_camera.translation() - world * estimate.translation();
  }
  const Eigen::VectorXd solution = a.colPivHouseholderQr().solve(b);
  return {SE3(world, solution.head<3>()), SE3(offset, solution.tail<3>())};
}

}  // namespace dxslam::benchmark
