// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "optimization/pose_graph.h"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <memory>
#include <utility>

#include "core/error.h"
#include "optimization/quiet_log.h"
#include "optimization/stop_callback.h"

namespace dxslam {
namespace {

// Ambient layout of a node: qx qy qz qw tx ty tz scale.
using NodeBlock = std::array<double, 8>;

Sim3 to_node(const double* block) {
  return {block[7], Eigen::Quaterniond(Eigen::Map<const Eigen::Vector4d>(block)),
          Eigen::Map<const Eigen::Vector3d>(block + 4)};
}

void to_block(const Sim3& node, double* block) {
  Eigen::Map<Eigen::Vector4d>{block} = node.rotation().coeffs();
  Eigen::Map<Eigen::Vector3d>{block + 4} = node.translation();
  block[7] = node.scale();
}

// Perturbation from the right, node * exp(delta). The cost function gives its derivative by
// (rho, phi, sigma) in the first seven ambient columns, so the "Jacobian of plus" only drops the
// eighth, and the seventh as well where the scale is held.
template <int Tangent>
class RightPerturbation final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 8; }
  int TangentSize() const override { return Tangent; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    Vector7d step = Vector7d::Zero();
    step.head<Tangent>() = Eigen::Map<const Eigen::Matrix<double, Tangent, 1>>(delta);
    to_block(to_node(x) * Sim3::exp(step), x_plus_delta);
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 8, Tangent, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    const Vector7d difference = (to_node(x).inverse() * to_node(y)).log();
    Eigen::Map<Eigen::Matrix<double, Tangent, 1>>{y_minus_x} = difference.head<Tangent>();
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, Tangent, 8, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
};

class EdgeError final : public ceres::SizedCostFunction<7, 8, 8> {
 public:
  explicit EdgeError(const PoseGraph::Edge& edge) : b_from_a_(edge.a_from_b.inverse()) {
    const Eigen::LLT<Matrix7d> factor(edge.information);
    require(edge.information.allFinite() && factor.info() == Eigen::Success,
            "the information of a pose graph edge is not positive definite");
    root_ = factor.matrixU();
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Sim3 a_from_b = to_node(parameters[0]).inverse() * to_node(parameters[1]);
    const Vector7d error = (b_from_a_ * a_from_b).log();
    Eigen::Map<Vector7d>{residuals} = root_ * error;
    if (jacobians == nullptr) return true;
    const Matrix7d by_b = root_ * sim3_right_jacobian_inverse(error);
    if (jacobians[0] != nullptr) write(-by_b * a_from_b.inverse().adjoint(), jacobians[0]);
    if (jacobians[1] != nullptr) write(by_b, jacobians[1]);
    return true;
  }

 private:
  static void write(const Matrix7d& by_tangent, double* jacobian) {
    Eigen::Map<Eigen::Matrix<double, 7, 8, Eigen::RowMajor>> ambient(jacobian);
    ambient.leftCols<7>() = by_tangent;
    ambient.rightCols<1>().setZero();
  }

  Sim3 b_from_a_;
  Matrix7d root_;  ///< root^T root = information
};

void check_edges(const PoseGraph& graph) {
  const auto inside = [&](int node) {
    return node >= 0 && static_cast<std::size_t>(node) < graph.nodes.size();
  };
  for (const PoseGraph::Edge& edge : graph.edges) {
    require(inside(edge.a) && inside(edge.b), "pose graph edge of a node that is not there");
    require(edge.a != edge.b, "pose graph edge from a node to itself");
  }
}

/// Owns all that the ceres::Problem points to.
class Model {
 public:
  Model(const PoseGraph& graph, const PoseGraphOptions& options)
      : blocks_(graph.nodes.size()), problem_(problem_options()) {
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      to_block(graph.nodes[i].world_from_node, blocks_[i].data());
    }
    if (options.huber > 0.0) loss_ = std::make_unique<ceres::HuberLoss>(options.huber);
    for (const PoseGraph::Edge& edge : graph.edges) {
      problem_.AddResidualBlock(&errors_.emplace_back(edge), loss_.get(), block(edge.a),
                                block(edge.b));
    }
    const bool any_fixed = std::any_of(graph.nodes.begin(), graph.nodes.end(),
                                       [](const PoseGraph::Node& node) { return node.fixed; });
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      double* node = blocks_[i].data();
      if (!problem_.HasParameterBlock(node)) continue;
      problem_.SetManifold(node, options.with_scale ? static_cast<ceres::Manifold*>(&similar_)
                                                    : static_cast<ceres::Manifold*>(&rigid_));
      const bool held = any_fixed ? graph.nodes[i].fixed : i == 0;
      if (held) problem_.SetParameterBlockConstant(node);
    }
  }

  ceres::Problem& problem() { return problem_; }
  Sim3 node(std::size_t i) const { return to_node(blocks_[i].data()); }
  /// Whether the solver may have moved the node.
  bool is_free(std::size_t i) const {
    const double* node = blocks_[i].data();
    return problem_.HasParameterBlock(node) && !problem_.IsParameterBlockConstant(node);
  }

 private:
  static ceres::Problem::Options problem_options() {
    ceres::Problem::Options options;
    options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }
  double* block(int node) { return blocks_[static_cast<std::size_t>(node)].data(); }

  std::vector<NodeBlock> blocks_;
  std::deque<EdgeError> errors_;
  std::unique_ptr<ceres::LossFunction> loss_;
  RightPerturbation<6> rigid_;
  RightPerturbation<7> similar_;
  ceres::Problem problem_;
};

ceres::Solver::Options solver_options(const PoseGraphOptions& options) {
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  solver.dense_linear_algebra_library_type = ceres::EIGEN;
  solver.max_num_iterations = options.iterations;
  solver.num_threads = options.threads;
  solver.function_tolerance = 1e-9;
  solver.logging_type = ceres::SILENT;
  return solver;
}

bool finite(const Sim3& s) { return s.matrix().allFinite() && s.scale() > 0.0; }

}  // namespace

PoseGraphReport optimize_pose_graph(PoseGraph& graph, const PoseGraphOptions& options,
                                    const MayGoOn& may_go_on) {
  check_edges(graph);
  PoseGraphReport report;
  Model model(graph, options);
  report.cancelled = must_stop(may_go_on);
  if (report.cancelled) return report;

  ceres::Solver::Options solver = solver_options(options);
  StopCallback callback(may_go_on);
  solver.callbacks.push_back(&callback);
  ceres::Solver::Summary summary;
  const QuietLog quiet;
  ceres::Solve(solver, &model.problem(), &summary);

  report.cancelled = summary.termination_type == ceres::USER_FAILURE;
  report.iterations = std::max(0, static_cast<int>(summary.iterations.size()) - 1);
  report.initial_cost = summary.initial_cost;
  report.final_cost = summary.final_cost;
  if (report.cancelled || !summary.IsSolutionUsable()) return report;
  std::vector<PoseGraph::Node> nodes = graph.nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!model.is_free(i)) continue;
    nodes[i].world_from_node = model.node(i);
    if (!finite(nodes[i].world_from_node)) return report;
  }
  graph.nodes = std::move(nodes);
  report.usable = true;
  return report;
}

}  // namespace dxslam
