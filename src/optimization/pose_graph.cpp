// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "optimization/pose_graph.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

#include "core/error.h"
#include "optimization/huber.h"
#include "optimization/levenberg_marquardt.h"
#include "optimization/sparse_blocks.h"

namespace dxslam {
namespace {

constexpr double kMinDecrease = 1e-9;   // share of the cost that a step must gain
constexpr double kTinyDiagonal = 1e-9;  // keeps directions without any constraint solvable

void check_edges(const PoseGraph& graph) {
  const auto inside = [&](int node) {
    return node >= 0 && static_cast<std::size_t>(node) < graph.nodes.size();
  };
  for (const PoseGraph::Edge& edge : graph.edges) {
    require(inside(edge.a) && inside(edge.b), "pose graph edge of a node that is not there");
    require(edge.a != edge.b, "pose graph edge from a node to itself");
    require(edge.information.allFinite() &&
                Eigen::LLT<Matrix7d>(edge.information).info() == Eigen::Success,
            "the information of a pose graph edge is not positive definite");
  }
}

bool finite(const Sim3& s) { return s.matrix().allFinite() && s.scale() > 0.0; }

/// What descend() asks for. A free node moves by a perturbation from the right, node * exp(delta);
/// Tangent is 6 where its scale is held, else 7.
template <int Tangent>
class GraphProblem {
 public:
  GraphProblem(const PoseGraph& graph, const std::vector<int>& slots, int free_nodes, double huber)
      : edges_(graph.edges),
        slots_(slots),
        huber_(huber),
        system_(Tangent, free_nodes, coupled(graph.edges, slots)),
        gradient_(Tangent * free_nodes),
        diagonal_(Tangent * free_nodes),
        step_(Tangent * free_nodes) {
    for (const PoseGraph::Node& node : graph.nodes) state_.push_back(node.world_from_node);
    for (const PoseGraph::Edge& edge : edges_) b_from_a_.push_back(edge.a_from_b.inverse());
    for (int i = 0; i < free_nodes; ++i) diagonal_places_.push_back(system_.place(i, i));
  }

  const std::vector<Sim3>& state() const { return state_; }

  double linearise() {
    system_.set_zero();
    gradient_.setZero();
    double sum = 0.0;
    for (std::size_t i = 0; i < edges_.size(); ++i) sum += linearise(i);
    for (std::size_t i = 0; i < diagonal_places_.size(); ++i) {
      diagonal_.segment<Tangent>(at(static_cast<int>(i))) =
          system_.block(diagonal_places_[i]).diagonal();
    }
    return 0.5 * sum;
  }

  double propose(double damping) {
    const Eigen::VectorXd damped =
        (1.0 + damping) * diagonal_ + Eigen::VectorXd::Constant(diagonal_.size(), kTinyDiagonal);
    for (std::size_t i = 0; i < diagonal_places_.size(); ++i) {
      system_.block(diagonal_places_[i]).diagonal() =
          damped.segment<Tangent>(at(static_cast<int>(i)));
    }
    step_ = -gradient_;
    if (!system_.solve(step_) || !step_.allFinite()) return -1.0;
    trial_ = state_;
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      if (slots_[i] < 0) continue;
      Vector7d delta = Vector7d::Zero();
      delta.head<Tangent>() = step_.segment<Tangent>(at(slots_[i]));
      trial_[i] = state_[i] * Sim3::exp(delta);
    }
    return 0.5 * (damping * step_.cwiseAbs2().dot(diagonal_) - step_.dot(gradient_));
  }

  double trial_cost() const {
    double sum = 0.0;
    double weight = 1.0;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const Vector7d error = (b_from_a_[i] * a_from_b(trial_, edges_[i])).log();
      sum += kernel(error.dot(edges_[i].information * error), weight);
    }
    return 0.5 * sum;
  }

  void accept() { std::swap(state_, trial_); }

 private:
  using Block = Eigen::Matrix<double, Tangent, Tangent>;

  static Eigen::Index at(int slot) { return static_cast<Eigen::Index>(Tangent) * slot; }

  static std::vector<std::pair<int, int>> coupled(const std::vector<PoseGraph::Edge>& edges,
                                                  const std::vector<int>& slots) {
    std::vector<std::pair<int, int>> pairs;
    for (const PoseGraph::Edge& edge : edges) {
      const int a = slots[static_cast<std::size_t>(edge.a)];
      const int b = slots[static_cast<std::size_t>(edge.b)];
      if (a >= 0 && b >= 0) pairs.emplace_back(std::max(a, b), std::min(a, b));
    }
    return pairs;
  }

  static Sim3 a_from_b(const std::vector<Sim3>& state, const PoseGraph::Edge& edge) {
    return state[static_cast<std::size_t>(edge.a)].inverse() *
           state[static_cast<std::size_t>(edge.b)];
  }

  double kernel(double error2, double& weight) const {
    weight = 1.0;
    return huber_ > 0.0 ? huber(error2, huber_ * huber_, weight) : error2;
  }

  double linearise(std::size_t i) {
    const PoseGraph::Edge& edge = edges_[i];
    const Sim3 a_from_b = this->a_from_b(state_, edge);
    const Vector7d error = (b_from_a_[i] * a_from_b).log();
    const Vector7d pull = edge.information * error;
    double weight = 1.0;
    const double cost = kernel(error.dot(pull), weight);

    const Matrix7d whole = sim3_right_jacobian_inverse(error);
    const Eigen::Matrix<double, 7, Tangent> by_b = whole.leftCols<Tangent>();
    const Eigen::Matrix<double, 7, Tangent> by_a =
        -(whole * a_from_b.inverse().adjoint()).template leftCols<Tangent>();
    const Eigen::Matrix<double, 7, Tangent> weighted_a = weight * edge.information * by_a;
    const Eigen::Matrix<double, 7, Tangent> weighted_b = weight * edge.information * by_b;
    const int a = slots_[static_cast<std::size_t>(edge.a)];
    const int b = slots_[static_cast<std::size_t>(edge.b)];
    if (a >= 0) add(a, a, by_a.transpose() * weighted_a);
    if (b >= 0) add(b, b, by_b.transpose() * weighted_b);
    if (a >= 0 && b >= 0 && a > b) add(a, b, by_a.transpose() * weighted_b);
    if (a >= 0 && b >= 0 && a < b) add(b, a, by_b.transpose() * weighted_a);
    if (a >= 0) gradient_.segment<Tangent>(at(a)) += weight * by_a.transpose() * pull;
    if (b >= 0) gradient_.segment<Tangent>(at(b)) += weight * by_b.transpose() * pull;
    return cost;
  }

  void add(int row, int column, const Block& block) {
    system_.block(system_.place(row, column)) += block;
  }

  const std::vector<PoseGraph::Edge>& edges_;
  const std::vector<int>& slots_;  ///< one per node: place among the free ones, or -1
  double huber_;
  std::vector<Sim3> b_from_a_;  ///< measured, one per edge
  std::vector<Sim3> state_;     ///< world_from_node
  std::vector<Sim3> trial_;
  SparseBlocks system_;
  std::vector<int> diagonal_places_;
  Eigen::VectorXd gradient_;
  Eigen::VectorXd diagonal_;  ///< of the normal equations, without damping
  Eigen::VectorXd step_;
};

/// Place of each node among the free ones, -1 for those that are held or have no edge.
std::vector<int> number_free_nodes(const PoseGraph& graph, int& count) {
  std::vector<int> slots(graph.nodes.size(), -1);
  for (const PoseGraph::Edge& edge : graph.edges) {
    slots[static_cast<std::size_t>(edge.a)] = slots[static_cast<std::size_t>(edge.b)] = 0;
  }
  const bool any_fixed = std::any_of(graph.nodes.begin(), graph.nodes.end(),
                                     [](const PoseGraph::Node& node) { return node.fixed; });
  count = 0;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (any_fixed ? graph.nodes[i].fixed : i == 0) slots[i] = -1;
    if (slots[i] >= 0) slots[i] = count++;
  }
  return slots;
}

template <int Tangent>
PoseGraphReport optimize(PoseGraph& graph, const PoseGraphOptions& options,
                         const MayGoOn& may_go_on) {
  int free_nodes = 0;
  const std::vector<int> slots = number_free_nodes(graph, free_nodes);
  GraphProblem<Tangent> problem(graph, slots, free_nodes, options.huber);
  const DescentReport descent = descend(problem, options.iterations, kMinDecrease, may_go_on);

  PoseGraphReport report;
  report.cancelled = descent.cancelled;
  report.iterations = descent.iterations;
  report.initial_cost = descent.initial_cost;
  report.final_cost = descent.final_cost;
  if (!descent.usable) return report;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (slots[i] >= 0 && !finite(problem.state()[i])) return report;
  }
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (slots[i] >= 0) graph.nodes[i].world_from_node = problem.state()[i];
  }
  report.usable = true;
  return report;
}

}  // namespace

PoseGraphReport optimize_pose_graph(PoseGraph& graph, const PoseGraphOptions& options,
                                    const MayGoOn& may_go_on) {
  check_edges(graph);
  if (must_stop(may_go_on)) {
    PoseGraphReport report;
    report.cancelled = true;
    return report;
  }
  return options.with_scale ? optimize<7>(graph, options, may_go_on)
                            : optimize<6>(graph, options, may_go_on);
}

}  // namespace dxslam
