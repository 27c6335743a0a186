// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// What bundle adjustment, motion-only optimisation and PnP cost, in CPU time of one thread:
//   cmake --preset release -DDXSLAM_BUILD_BENCHMARKS=ON
//   ninja -C build/release optimization_benchmark && build/release/optimization_benchmark
#include <benchmark/benchmark.h>

#include <cmath>

#include "geometry/geometry_scene.h"
#include "geometry/pnp.h"
#include "optimization/bundle_engine.h"
#include "optimization/bundle_test_scene.h"
#include "optimization/pose_graph.h"
#include "optimization/pose_optimizer.h"

namespace dxslam {
namespace {

BundleScene bundle_scene(const benchmark::State& state) {
  BundleSceneOptions options;
  options.poses = static_cast<int>(state.range(0));
  options.points = static_cast<int>(state.range(1));
  options.outlier_share = 0.05;
  options.observations_per_point = state.range(0) > 100 ? 15 : 5;
  return make_bundle_scene(options);
}

void adjust_whole_bundle(benchmark::State& state) {
  const BundleScene scene = bundle_scene(state);
  for (auto _ : state) {
    BundleProblem problem = scene.problem;
    benchmark::DoNotOptimize(adjust_bundle(problem, BundleOptions()));
  }
  state.counters["observations"] = static_cast<double>(scene.problem.observations.size());
}
BENCHMARK(adjust_whole_bundle)
    ->Args({5, 600})
    ->Args({20, 2500})
    ->Args({50, 5000})
    ->Args({100, 8000})
    ->Unit(benchmark::kMillisecond);

/// Five robust steps, the poses solved for densely (0) or sparsely (1).
void take_bundle_steps(benchmark::State& state) {
  const BundleScene scene = bundle_scene(state);
  BundleOptions options;
  options.min_decrease = 0.0;
  BundleStage stage;
  stage.problem = &scene.problem;
  stage.options = &options;
  stage.active.assign(scene.problem.observations.size(), 1);
  stage.iterations = 5;
  stage.max_dense_poses = state.range(2) == 0 ? 1000000 : 0;
  stage.max_coupled_share = 1.0;
  BundleState start;
  for (const BundleProblem::Pose& pose : scene.problem.poses) {
    start.camera_from_world.push_back(pose.world_from_camera.inverse());
    stage.held.push_back(pose.fixed ? 1 : 0);
  }
  start.points = scene.problem.points;
  for (auto _ : state) {
    BundleState current = start;
    benchmark::DoNotOptimize(minimise_bundle(stage, current));
  }
}
BENCHMARK(take_bundle_steps)
    ->ArgsProduct({{20}, {2500}, {0, 1}})
    ->ArgsProduct({{100}, {8000}, {0, 1}})
    ->ArgsProduct({{450}, {20000}, {0, 1}})
    ->ArgsProduct({{1000}, {40000}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

/// A camera that goes round a room `laps` times: edges to the nodes before and to those of the lap
/// before, and odometry that drifts.
PoseGraph drifted_graph(int nodes, int lap) {
  SampleSource source(1);
  std::vector<Sim3> truth;
  PoseGraph graph;
  for (int i = 0; i < nodes; ++i) {
    const double angle = 2.0 * M_PI * i / lap;
    truth.emplace_back(1.0, so3_exp({0.0, angle, 0.0}),
                       Eigen::Vector3d(3.0 * std::cos(angle), 0.0, 3.0 * std::sin(angle)));
    if (i == 0) {
      graph.nodes.push_back({truth[0], true});
      continue;
    }
    const auto k = static_cast<std::size_t>(i);
    Vector7d noise;
    noise << source.tangent(0.003), 0.0;
    graph.nodes.push_back({graph.nodes[k - 1].world_from_node *
                           (truth[k - 1].inverse() * truth[k]) * Sim3::exp(noise)});
    for (const int back : {1, 2, 3, 4, lap - 1, lap, lap + 1}) {
      if (back > i) continue;
      const Sim3& other = truth[k - static_cast<std::size_t>(back)];
      graph.edges.push_back({i - back, i, other.inverse() * truth[k]});
    }
  }
  return graph;
}

void close_loops(benchmark::State& state) {
  const PoseGraph start =
      drifted_graph(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  PoseGraphReport report;
  for (auto _ : state) {
    PoseGraph graph = start;
    report = optimize_pose_graph(graph, PoseGraphOptions());
    benchmark::DoNotOptimize(report);
  }
  state.counters["steps"] = report.iterations;
  state.counters["final_cost"] = report.final_cost;
}
BENCHMARK(close_loops)
    ->Args({100, 40})
    ->Args({500, 100})
    ->Args({2000, 200})
    ->Unit(benchmark::kMillisecond);

void optimize_camera_pose(benchmark::State& state) {
  SampleSource source(1);
  const ViewScene scene = make_view_scene(source, static_cast<int>(state.range(0)), 0.2, 1.0);
  const Camera camera = test_camera();
  std::vector<PoseObservation> observations(scene.points.size());
  for (std::size_t i = 0; i < observations.size(); ++i) {
    observations[i].point_in_world = scene.points[i];
    observations[i].measured.pixel = scene.pixels[i];
    if (i % 3 != 0) observations[i].measured.disparity = camera.bf() / scene.depths[i];
  }
  const SE3 start = scene.world_from_camera * SE3::exp(source.tangent(0.05));
  for (auto _ : state) {
    benchmark::DoNotOptimize(optimize_pose(camera, start, observations, PoseOptimizerOptions()));
  }
}
BENCHMARK(optimize_camera_pose)->Arg(100)->Arg(300)->Arg(1000)->Unit(benchmark::kMicrosecond);

void solve_pnp_with_outliers(benchmark::State& state) {
  SampleSource source(1);
  const ViewScene scene = make_view_scene(source, 100, 0.6, 1.0);
  const std::vector<float> depths = state.range(0) != 0 ? scene.depths : std::vector<float>();
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        solve_pnp(test_camera(), scene.points, scene.pixels, depths, PnpOptions()));
  }
}
BENCHMARK(solve_pnp_with_outliers)->ArgName("depth")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace dxslam
