// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// Bundle adjustment by Ceres; pose_graph.cpp is the only other file that knows it.
#include <ceres/ceres.h>

#include <array>
#include <cmath>
#include <deque>

#include "optimization/bundle_engine.h"
#include "optimization/quiet_log.h"
#include "optimization/stop_callback.h"

namespace dxslam {
namespace {

constexpr int kMaxDensePoses = 100;  // above it the reduced camera system is sparse

// Ambient layout of a pose camera_from_world: qx qy qz qw tx ty tz.
using PoseBlock = std::array<double, 7>;

SE3 to_pose(const double* block) {
  return {Eigen::Quaterniond(Eigen::Map<const Eigen::Vector4d>(block)),
          Eigen::Map<const Eigen::Vector3d>(block + 4)};
}

void to_block(const SE3& pose, double* block) {
  Eigen::Map<Eigen::Vector4d>{block} = pose.rotation().coeffs();
  Eigen::Map<Eigen::Vector3d>{block + 4} = pose.translation();
}

// Left perturbation of a pose. The cost functions give their derivative by the six tangent numbers
// in the first six ambient columns, so the "Jacobian of plus" only drops the seventh.
class LeftPerturbation final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    to_block(SE3::exp(Eigen::Map<const Vector6d>(delta)) * to_pose(x), x_plus_delta);
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    Eigen::Map<Vector6d>{y_minus_x} = (to_pose(y) * to_pose(x).inverse()).log();
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
};

// Rows is 3 for an observation with depth, else 2.
template <int Rows>
class Reprojection final : public ceres::SizedCostFunction<Rows, 7, 3> {
 public:
  Reprojection(const Camera& camera, const BundleProblem::Observation& observation)
      : camera_(camera), observation_(observation) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const SE3 camera_from_world = to_pose(parameters[0]);
    const Eigen::Vector3d p = camera_from_world * Eigen::Map<const Eigen::Vector3d>(parameters[1]);
    Eigen::Map<Eigen::Matrix<double, Rows, 1>> r(residuals);
    r = bundle_residual(camera_, observation_, p).template head<Rows>();
    if (jacobians == nullptr) return true;
    const Eigen::Matrix<double, Rows, 3> by_point =
        bundle_jacobian(camera_, observation_, p).template topRows<Rows>();
    if (jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, Rows, 7, Eigen::RowMajor>> j(jacobians[0]);
      j.template leftCols<6>() = left_perturbation_jacobian<Rows>(by_point, p);
      j.template rightCols<1>().setZero();
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, Rows, 3, Eigen::RowMajor>> j(jacobians[1]);
      j = by_point * camera_from_world.rotation().toRotationMatrix();
    }
    return true;
  }

 private:
  const Camera& camera_;
  const BundleProblem::Observation& observation_;
};

/// Owns all that a ceres::Problem points to. Must be declared before, so that it outlives, the
/// problem.
struct Model {
  std::vector<PoseBlock> poses;
  std::vector<Eigen::Vector3d> points;
  std::deque<Reprojection<2>> pixel_costs;
  std::deque<Reprojection<3>> depth_costs;
  LeftPerturbation manifold;
  ceres::HuberLoss pixel_loss;
  ceres::HuberLoss depth_loss;

  Model(const BundleStage& stage, const BundleState& state)
      : poses(state.camera_from_world.size()),
        points(state.points),
        pixel_loss(std::sqrt(stage.options->chi2_pixel)),
        depth_loss(std::sqrt(stage.options->chi2_depth)) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      to_block(state.camera_from_world[i], poses[i].data());
    }
  }
};

ceres::Problem::Options problem_options() {
  ceres::Problem::Options options;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.disable_all_safety_checks = true;
  return options;
}

void add_residuals(const BundleStage& stage, Model& model, ceres::Problem& problem) {
  for (std::size_t i = 0; i < stage.problem->observations.size(); ++i) {
    if (stage.active[i] == 0) continue;
    const BundleProblem::Observation& o = stage.problem->observations[i];
    double* pose = model.poses[static_cast<std::size_t>(o.pose)].data();
    double* point = model.points[static_cast<std::size_t>(o.point)].data();
    if (has_depth(o)) {
      problem.AddResidualBlock(&model.depth_costs.emplace_back(*stage.camera, o),
                               stage.robust ? &model.depth_loss : nullptr, pose, point);
    } else {
      problem.AddResidualBlock(&model.pixel_costs.emplace_back(*stage.camera, o),
                               stage.robust ? &model.pixel_loss : nullptr, pose, point);
    }
  }
}

ceres::Solver::Options solver_options(const BundleStage& stage, int free_poses) {
  ceres::Solver::Options options;
  options.linear_solver_type =
      free_poses <= kMaxDensePoses ? ceres::DENSE_SCHUR : ceres::SPARSE_SCHUR;
  // SuiteSparse is under the GPL in parts; Eigen serves as well here.
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.dense_linear_algebra_library_type = ceres::EIGEN;
  options.max_num_iterations = stage.iterations;
  options.num_threads = stage.options->threads;
  options.function_tolerance = stage.options->min_decrease;
  options.logging_type = ceres::SILENT;
  return options;
}

// Points are eliminated first, whatever order the blocks came in. Returns the number of free poses.
int arrange_blocks(const BundleStage& stage, Model& model, ceres::Problem& problem,
                   ceres::ParameterBlockOrdering& ordering) {
  int free_poses = 0;
  for (std::size_t i = 0; i < model.poses.size(); ++i) {
    double* block = model.poses[i].data();
    if (!problem.HasParameterBlock(block)) continue;
    problem.SetManifold(block, &model.manifold);
    ordering.AddElementToGroup(block, 1);
    if (stage.held[i] != 0) {
      problem.SetParameterBlockConstant(block);
    } else {
      ++free_poses;
    }
  }
  for (Eigen::Vector3d& point : model.points) {
    if (problem.HasParameterBlock(point.data())) ordering.AddElementToGroup(point.data(), 0);
  }
  return free_poses;
}

}  // namespace

BundleStageReport minimise_with_ceres(const BundleStage& stage, BundleState& state) {
  Model model(stage, state);
  ceres::Problem problem(problem_options());
  add_residuals(stage, model, problem);
  const auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  const int free_poses = arrange_blocks(stage, model, problem, *ordering);
  ceres::Solver::Options options = solver_options(stage, free_poses);
  options.linear_solver_ordering = ordering;
  StopCallback callback(stage.may_go_on);
  options.callbacks.push_back(&callback);

  const QuietLog quiet;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  BundleStageReport report;
  report.cancelled = summary.termination_type == ceres::USER_FAILURE;
  report.usable = !report.cancelled && summary.IsSolutionUsable();
  report.iterations = static_cast<int>(summary.iterations.size()) - 1;
  if (!report.usable) return report;
  for (std::size_t i = 0; i < model.poses.size(); ++i) {
    if (stage.held[i] == 0) state.camera_from_world[i] = to_pose(model.poses[i].data());
  }
  state.points = model.points;
  return report;
}

}  // namespace dxslam
