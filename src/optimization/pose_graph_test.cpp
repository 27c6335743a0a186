// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "optimization/pose_graph.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/options.h"
#include "core/transform_samples.h"
#include "optimization/test_least_squares.h"

namespace dxslam {
namespace {

struct LoopScene {
  PoseGraph graph;  ///< exact edges, drifted nodes
  std::vector<Sim3> truth;
};

/// A camera that walks a circle of 3 m and comes back; odometry drifts in pose and, if asked,
/// scale.
LoopScene make_loop(int nodes, double scale_drift) {
  SampleSource source(1);
  LoopScene scene;
  for (int i = 0; i < nodes; ++i) {
    const double angle = 2.0 * M_PI * i / nodes;
    scene.truth.emplace_back(1.0, so3_exp({0.1 * std::sin(angle), angle, 0.0}),
                             Eigen::Vector3d(3.0 * std::cos(angle), 0.2, 3.0 * std::sin(angle)));
  }
  Sim3 drifted = scene.truth[0];
  for (int i = 0; i < nodes; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (i > 0) {
      Vector7d noise;
      noise << source.tangent(0.01), scale_drift;
      drifted = drifted * (scene.truth[k - 1].inverse() * scene.truth[k]) * Sim3::exp(noise);
    }
    scene.graph.nodes.push_back({drifted, i == 0});
    const int next = (i + 1) % nodes;
    const Sim3& other = scene.truth[static_cast<std::size_t>(next)];
    scene.graph.edges.push_back({i, next, scene.truth[k].inverse() * other});
  }
  return scene;
}

double worst_error(const LoopScene& scene, const PoseGraph& graph) {
  double worst = 0.0;
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    const Sim3 difference = graph.nodes[i].world_from_node.inverse() * scene.truth[i];
    worst = std::max(worst, difference.log().norm());
  }
  return worst;
}

void expect_same(const PoseGraph& a, const PoseGraph& b) {
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    EXPECT_EQ(a.nodes[i].world_from_node.matrix(), b.nodes[i].world_from_node.matrix()) << i;
  }
}

TEST(PoseGraph, ClosesARigidLoop) {
  const LoopScene scene = make_loop(60, 0.0);
  PoseGraph graph = scene.graph;
  const PoseGraphReport report = optimize_pose_graph(graph, PoseGraphOptions());
  ASSERT_TRUE(report.usable);
  EXPECT_GT(worst_error(scene, scene.graph), 0.05);
  EXPECT_LT(worst_error(scene, graph), 1e-4);
  EXPECT_LT(report.final_cost, 1e-6 * report.initial_cost);
  EXPECT_EQ(graph.nodes[0].world_from_node.matrix(), scene.graph.nodes[0].world_from_node.matrix());
  for (const PoseGraph::Node& node : graph.nodes) EXPECT_EQ(node.world_from_node.scale(), 1.0);
}

TEST(PoseGraph, ClosesALoopThatDriftedInScale) {
  const LoopScene scene = make_loop(40, 0.01);
  PoseGraph graph = scene.graph;
  PoseGraphOptions options;
  options.with_scale = true;
  options.iterations = 100;
  ASSERT_TRUE(optimize_pose_graph(graph, options).usable);
  EXPECT_GT(std::abs(std::log(scene.graph.nodes.back().world_from_node.scale())), 0.3);
  EXPECT_LT(worst_error(scene, graph), 1e-4);
}

TEST(PoseGraph, SpreadsTheErrorOfALoopOverIt) {
  // Odometry that misses the start by 0.6 m, of equal weight everywhere: each of the edges takes a
  // share, none breaks.
  PoseGraph graph;
  constexpr int kNodes = 12;
  for (int i = 0; i < kNodes; ++i) {
    graph.nodes.push_back({Sim3(1.0, Eigen::Quaterniond::Identity(), {0.1 * i, 0.0, 0.0}), i == 0});
    if (i > 0) {
      graph.edges.push_back({i - 1, i, Sim3(1.0, Eigen::Quaterniond::Identity(), {0.1, 0.0, 0.0})});
    }
  }
  graph.edges.push_back(
      {kNodes - 1, 0, Sim3(1.0, Eigen::Quaterniond::Identity(), {-0.5, 0.0, 0.0})});
  ASSERT_TRUE(optimize_pose_graph(graph, PoseGraphOptions()).usable);
  for (int i = 0; i < kNodes; ++i) {
    // The surplus of 0.6 m is shared by 12 edges of unit weight.
    EXPECT_NEAR(graph.nodes[static_cast<std::size_t>(i)].world_from_node.translation().x(),
                0.05 * i, 1e-5);
  }
}

TEST(PoseGraph, WeighsEdgesByTheirInformation) {
  PoseGraph graph;
  graph.nodes = {{Sim3(), true}, {Sim3(), false}};
  const Sim3 near(1.0, Eigen::Quaterniond::Identity(), {1.0, 0.0, 0.0});
  const Sim3 far(1.0, Eigen::Quaterniond::Identity(), {2.0, 0.0, 0.0});
  graph.edges = {{0, 1, near, 3.0 * Matrix7d::Identity()}, {0, 1, far, Matrix7d::Identity()}};
  ASSERT_TRUE(optimize_pose_graph(graph, PoseGraphOptions()).usable);
  EXPECT_NEAR(graph.nodes[1].world_from_node.translation().x(), 1.25, 1e-4);
}

TEST(PoseGraph, KernelLimitsTheHarmOfAWrongLoop) {
  LoopScene scene = make_loop(60, 0.0);
  for (PoseGraph::Edge& edge : scene.graph.edges) edge.information *= 1e4;
  scene.graph.edges.push_back({10, 20, Sim3(), 1e4 * Matrix7d::Identity()});
  PoseGraph plain = scene.graph;
  PoseGraph robust = scene.graph;
  PoseGraphOptions options;
  options.iterations = 100;
  ASSERT_TRUE(optimize_pose_graph(plain, options).usable);
  options.huber = 1.0;
  ASSERT_TRUE(optimize_pose_graph(robust, options).usable);
  EXPECT_GT(worst_error(scene, plain), 0.5);
  EXPECT_LT(worst_error(scene, robust), 0.2);
}

/// Nodes all over the place with edges that contradict each other, of different weights, and one
/// that is far off.
PoseGraph make_contradiction(std::uint32_t seed) {
  SampleSource source(seed);
  PoseGraph graph;
  for (int i = 0; i < 8; ++i) {
    Vector7d tangent;
    tangent << source.tangent(1.0), source.uniform(-0.2, 0.2);
    graph.nodes.push_back({Sim3::exp(tangent), i == 2});
  }
  for (int i = 0; i < 8; ++i) {
    for (const int step : {1, 3}) {
      const int next = (i + step) % 8;
      Vector7d noise;
      noise << source.tangent(0.1), source.uniform(-0.1, 0.1);
      const Sim3 a_from_b = graph.nodes[static_cast<std::size_t>(i)].world_from_node.inverse() *
                            graph.nodes[static_cast<std::size_t>(next)].world_from_node;
      Matrix7d root = Matrix7d::Identity() * source.uniform(5.0, 20.0);
      root(0, 4) = source.uniform(-3.0, 3.0);
      graph.edges.push_back({i, next, a_from_b * Sim3::exp(noise), root.transpose() * root});
    }
  }
  graph.edges[5].a_from_b = graph.edges[5].a_from_b * Sim3::exp(Vector7d::Constant(0.3));
  for (PoseGraph::Node& node : graph.nodes) {
    Vector7d noise;
    noise << source.tangent(0.2), 0.0;
    if (!node.fixed) node.world_from_node = node.world_from_node * Sim3::exp(noise);
  }
  return graph;
}

TEST(PoseGraph, FindsTheMinimumThatMinpackFinds) {
  for (const bool with_scale : {false, true}) {
    for (const double huber : {0.0, 2.0}) {
      const PoseGraph start = make_contradiction(7);
      const Eigen::Index tangent = with_scale ? 7 : 6;
      const auto moved = [&](const Eigen::VectorXd& delta) {
        std::vector<Sim3> nodes;
        Eigen::Index next = 0;
        for (const PoseGraph::Node& node : start.nodes) {
          nodes.push_back(node.world_from_node);
          if (node.fixed) continue;
          Vector7d step = Vector7d::Zero();
          step.head(tangent) = delta.segment(next, tangent);
          nodes.back() = nodes.back() * Sim3::exp(step);
          next += tangent;
        }
        return nodes;
      };
      const auto residuals = [&](const Eigen::VectorXd& delta, Eigen::VectorXd& r) {
        const std::vector<Sim3> nodes = moved(delta);
        for (std::size_t i = 0; i < start.edges.size(); ++i) {
          const PoseGraph::Edge& edge = start.edges[i];
          const Sim3 apart = edge.a_from_b.inverse() *
                             nodes[static_cast<std::size_t>(edge.a)].inverse() *
                             nodes[static_cast<std::size_t>(edge.b)];
          const Matrix7d root = edge.information.llt().matrixU();
          const Vector7d error = root * apart.log();
          const double scale = huber > 0.0 ? huber_scale(error.squaredNorm(), huber * huber) : 1.0;
          r.segment<7>(7 * static_cast<Eigen::Index>(i)) = scale * error;
        }
      };
      const auto count = static_cast<Eigen::Index>(7 * start.edges.size());
      const Eigen::VectorXd minimum = minimise_by_minpack(7 * tangent, count, residuals);
      const std::vector<Sim3> expected = moved(minimum);
      Eigen::VectorXd r(count);
      residuals(minimum, r);

      PoseGraph graph = start;
      PoseGraphOptions options;
      options.iterations = 200;
      options.with_scale = with_scale;
      options.huber = huber;
      const PoseGraphReport report = optimize_pose_graph(graph, options);
      ASSERT_TRUE(report.usable);
      EXPECT_LT(report.final_cost, 0.5 * report.initial_cost);
      EXPECT_NEAR(report.final_cost, 0.5 * r.squaredNorm(), 1e-6 * report.final_cost);
      for (std::size_t i = 0; i < expected.size(); ++i) {
        const Sim3 apart = graph.nodes[i].world_from_node.inverse() * expected[i];
        EXPECT_LT(apart.log().norm(), 1e-3) << i;
      }
    }
  }
}

TEST(PoseGraph, HoldsTheFirstNodeIfNoneIsFixed) {
  LoopScene scene = make_loop(20, 0.0);
  scene.graph.nodes[0].fixed = false;
  PoseGraph graph = scene.graph;
  ASSERT_TRUE(optimize_pose_graph(graph, PoseGraphOptions()).usable);
  EXPECT_EQ(graph.nodes[0].world_from_node.matrix(), scene.graph.nodes[0].world_from_node.matrix());
  EXPECT_LT(worst_error(scene, graph), 1e-4);
}

TEST(PoseGraph, LeavesNodesWithoutEdgesAlone) {
  LoopScene scene = make_loop(20, 0.0);
  const Sim3 lonely(1.5, so3_exp({0.1, 0.2, 0.3}), {7.0, 8.0, 9.0});
  scene.graph.nodes.push_back({lonely, false});
  ASSERT_TRUE(optimize_pose_graph(scene.graph, PoseGraphOptions()).usable);
  EXPECT_EQ(scene.graph.nodes.back().world_from_node.matrix(), lonely.matrix());
}

TEST(PoseGraph, ChangesNothingWhenCancelled) {
  const LoopScene scene = make_loop(20, 0.0);
  PoseGraph graph = scene.graph;
  const PoseGraphReport report =
      optimize_pose_graph(graph, PoseGraphOptions(), [] { return false; });
  EXPECT_TRUE(report.cancelled);
  EXPECT_FALSE(report.usable);
  expect_same(graph, scene.graph);
}

TEST(PoseGraph, ChangesNothingIfANodeIsNotFinite) {
  LoopScene scene = make_loop(20, 0.0);
  scene.graph.nodes[5].world_from_node = Sim3(1.0, Eigen::Quaterniond::Identity(),
                                              {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0});
  PoseGraph graph = scene.graph;
  EXPECT_FALSE(optimize_pose_graph(graph, PoseGraphOptions()).usable);
  EXPECT_EQ(graph.nodes[6].world_from_node.matrix(), scene.graph.nodes[6].world_from_node.matrix());
}

TEST(PoseGraph, GivesTheSameAnswerTwice) {
  const LoopScene scene = make_loop(30, 0.005);
  PoseGraph a = scene.graph;
  PoseGraph b = scene.graph;
  optimize_pose_graph(a, PoseGraphOptions());
  optimize_pose_graph(b, PoseGraphOptions());
  expect_same(a, b);
}

TEST(PoseGraph, BearsAnEmptyGraph) {
  PoseGraph graph;
  EXPECT_EQ(optimize_pose_graph(graph, PoseGraphOptions()).final_cost, 0.0);
}

TEST(PoseGraph, ThrowsOnEdgesThatCannotBe) {
  const LoopScene scene = make_loop(10, 0.0);
  PoseGraph graph = scene.graph;
  graph.edges[3].b = 10;
  EXPECT_THROW(optimize_pose_graph(graph, PoseGraphOptions()), ContractError);
  graph = scene.graph;
  graph.edges[3].b = graph.edges[3].a;
  EXPECT_THROW(optimize_pose_graph(graph, PoseGraphOptions()), ContractError);
  graph = scene.graph;
  graph.edges[3].information(2, 2) = -1.0;
  EXPECT_THROW(optimize_pose_graph(graph, PoseGraphOptions()), ContractError);
}

TEST(PoseGraph, OptionsHaveValidDefaults) {
  EXPECT_NO_THROW(validate_options("pose_graph", PoseGraphOptions()));
}

}  // namespace
}  // namespace dxslam
