// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// How long a question to the index of global descriptors takes: 20 candidates out of all keyframes.
#include <benchmark/benchmark.h>

#include <random>

#include "core/random_unit.h"
#include "place/global_index.h"

namespace {

using dxslam::GlobalIndex;
using dxslam::random_unit;

void query(benchmark::State& state) {
  const auto keyframes = static_cast<std::uint32_t>(state.range(0));
  const auto dimension = static_cast<std::size_t>(state.range(1));
  std::mt19937 random(1);
  GlobalIndex index;
  for (std::uint32_t id = 0; id < keyframes; ++id) index.add(id, random_unit(random, dimension));
  const std::vector<float> wanted = random_unit(random, dimension);
  for (auto _ : state) benchmark::DoNotOptimize(index.query(wanted, 20));
}
BENCHMARK(query)
    ->ArgsProduct({{1000, 10000, 50000, 100000}, {256, 512}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
