// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// What bundle adjustment, motion-only optimisation and PnP cost, in CPU time of one thread:
//   cmake --preset release -DDXSLAM_BUILD_BENCHMARKS=ON
//   ninja -C build/release optimization_benchmark && build/release/optimization_benchmark
#include <benchmark/benchmark.h>

#include "geometry/geometry_scene.h"
#include "geometry/pnp.h"
#include "optimization/bundle_engine.h"
#include "optimization/bundle_test_scene.h"
#include "optimization/pose_optimizer.h"

namespace dxslam {
namespace {

BundleScene bundle_scene(const benchmark::State& state) {
  BundleSceneOptions options;
  options.poses = static_cast<int>(state.range(0));
  options.points = static_cast<int>(state.range(1));
  options.outlier_share = 0.05;
  return make_bundle_scene(options);
}

void adjust_whole_bundle(benchmark::State& state) {
  const BundleScene scene = bundle_scene(state);
  for (auto _ : state) {
    BundleProblem problem = scene.problem;
    benchmark::DoNotOptimize(adjust_bundle(scene.camera, problem, BundleOptions()));
  }
  state.counters["observations"] = static_cast<double>(scene.problem.observations.size());
}
BENCHMARK(adjust_whole_bundle)
    ->Args({5, 600})
    ->Args({20, 2500})
    ->Args({50, 5000})
    ->Args({100, 8000})
    ->Unit(benchmark::kMillisecond);

/// Five robust steps from the same start, by either solver.
void solve_bundle(benchmark::State& state,
                  BundleStageReport (*solver)(const BundleStage&, BundleState&)) {
  const BundleScene scene = bundle_scene(state);
  const BundleOptions options;
  BundleStage stage;
  stage.camera = &scene.camera;
  stage.problem = &scene.problem;
  stage.options = &options;
  stage.active.assign(scene.problem.observations.size(), 1);
  stage.iterations = 5;
  BundleState start;
  for (const BundleProblem::Pose& pose : scene.problem.poses) {
    start.camera_from_world.push_back(pose.world_from_camera.inverse());
    stage.held.push_back(pose.fixed ? 1 : 0);
  }
  start.points = scene.problem.points;
  for (auto _ : state) {
    BundleState current = start;
    benchmark::DoNotOptimize(solver(stage, current));
  }
}
BENCHMARK_CAPTURE(solve_bundle, own, minimise_with_schur)
    ->Args({20, 2500})
    ->Args({100, 8000})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(solve_bundle, ceres, minimise_with_ceres)
    ->Args({20, 2500})
    ->Args({100, 8000})
    ->Unit(benchmark::kMillisecond);

void optimize_camera_pose(benchmark::State& state) {
  SampleSource source(1);
  const ViewScene scene = make_view_scene(source, static_cast<int>(state.range(0)), 0.2, 1.0);
  const Camera camera = test_camera();
  std::vector<PoseObservation> observations(scene.points.size());
  for (std::size_t i = 0; i < observations.size(); ++i) {
    observations[i].point_in_world = scene.points[i];
    observations[i].pixel = scene.pixels[i];
    if (i % 3 != 0) observations[i].disparity = camera.bf() / scene.depths[i];
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
