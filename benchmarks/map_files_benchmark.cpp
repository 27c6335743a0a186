// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors

// Saving and loading a map of as many keyframes as the argument says, each of 1000 keypoints with
// 64 floats and a global descriptor of 512, 600 of them bound to points seen eight times.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>
#include <random>

#include "core/random_unit.h"
#include "core/test_camera.h"
#include "map_files/map_file.h"

namespace dxslam {
namespace {

constexpr int kKeypoints = 1000;
constexpr int kBound = 600;
constexpr int kTrack = 8;
constexpr int kWindow = 30;  // keyframes that see one place

FramePtr make_frame(int index, std::mt19937& random) {
  auto frame = std::make_shared<Frame>();
  frame->index = index;
  frame->stamp = index / 3.0;
  for (int i = 0; i < kKeypoints; ++i) {
    frame->pixels.emplace_back(static_cast<float>(random() % 640),
                               static_cast<float>(random() % 480));
    frame->depths.push_back(2.0F);
    frame->scores.push_back(0.5F);
    frame->sigmas.push_back(1.0F);
    frame->descriptors.push_back(cv::Mat(random_unit(random, 64)).t());
  }
  frame->global = random_unit(random, 512);
  return frame;
}

MapSnapshot make_snapshot(int keyframes) {
  std::mt19937 random(1);
  MapSnapshot snapshot;
  snapshot.parts.rig = Rig(test_camera());
  snapshot.header.extractor = "benchmark";
  snapshot.header.traits = {false, 64, 0.9F, 512};
  for (int k = 0; k < keyframes; ++k) {
    Keyframe keyframe;
    keyframe.id = static_cast<KeyframeId>(k);
    keyframe.frame = make_frame(k, random);
    keyframe.world_from_camera = SE3(Eigen::Quaterniond::Identity(), {0.1 * k, 0, 0});
    keyframe.parent = k == 0 ? kNoId : keyframe.id - 1;
    snapshot.parts.keyframes.push_back(std::move(keyframe));
  }
  snapshot.parts.last_keyframe = static_cast<KeyframeId>(keyframes - 1);
  std::vector<std::uint32_t> used(static_cast<std::size_t>(keyframes), 0);
  const int points = keyframes * kBound / kTrack;
  for (int i = 0; i < points; ++i) {
    MapPoint p;
    p.id = static_cast<PointId>(snapshot.parts.points.size());
    p.position = {0.1 * i * kTrack / kBound, 0.0, 2.0};
    p.normal = {0, 0, -1};
    for (int k = i * kTrack / kBound, end = std::min(k + kWindow, keyframes); k < end; ++k) {
      std::uint32_t& keypoint = used[static_cast<std::size_t>(k)];
      if (p.observations.size() == kTrack || keypoint == kKeypoints || random() % 3 == 0) continue;
      p.observations.push_back({static_cast<KeyframeId>(k), keypoint++});
    }
    if (p.observations.empty()) continue;
    p.created_by = p.observations.front().keyframe;
    snapshot.parts.points.push_back(std::move(p));
  }
  return snapshot;
}

// The file of a map of so many keyframes, made once; removed at the end.
class MapOnDisk {
 public:
  explicit MapOnDisk(int keyframes)
      : snapshot_(make_snapshot(keyframes)),
        path_(std::filesystem::temp_directory_path() /
              ("dxslam_benchmark_" + std::to_string(::getpid()) + ".dxmap")) {
    save_map(path_, snapshot_);
  }
  ~MapOnDisk() { std::filesystem::remove(path_); }
  MapOnDisk(const MapOnDisk&) = delete;
  MapOnDisk& operator=(const MapOnDisk&) = delete;
  const MapSnapshot& snapshot() const { return snapshot_; }
  const std::string& path() const { return path_; }

 private:
  MapSnapshot snapshot_;
  std::string path_;
};

void load(benchmark::State& state) {
  const MapOnDisk map(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(load_map(map.path()));
  state.counters["MiB"] = static_cast<double>(std::filesystem::file_size(map.path())) / 1048576.0;
}

void save(benchmark::State& state) {
  const MapOnDisk map(static_cast<int>(state.range(0)));
  for (auto _ : state) save_map(map.path(), map.snapshot());
}

void snapshot(benchmark::State& state) {
  const MapOnDisk disk(static_cast<int>(state.range(0)));
  const Map map(disk.snapshot().parts);
  for (auto _ : state) benchmark::DoNotOptimize(take_snapshot(disk.snapshot().header, map));
}

BENCHMARK(load)
    ->Arg(100)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(save)
    ->Arg(100)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(snapshot)->Arg(1000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace dxslam
