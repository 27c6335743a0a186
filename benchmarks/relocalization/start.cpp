// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "start.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "map_files/map_file.h"
#include "slam/event_reader.h"
#include "slam/stage_times.h"
#include "slam/system.h"

namespace dxslam::benchmark {
namespace {

using Times = std::vector<std::pair<std::string, std::vector<double>>>;

void note(Times& times, const std::string& what, double ms) {
  for (auto& [name, values] : times) {
    if (name == what) return values.push_back(ms);
  }
  times.push_back({what, {ms}});
}

void start_once(const Camera& camera, const RgbdImage& image,
                std::unique_ptr<FeatureExtractor> extractor, double network_ms,
                const std::string& file, Times& times) {
  const Stopwatch whole;
  StoredMap stored = load_map(file);
  const double loaded = whole.ms();
  SystemOptions options;
  options.mode = "localization";
  std::optional<double> first_pose;
  System system(camera, std::move(extractor), options);
  EventReader reader(system.subscribe(1, EventKinds::of<FrameTracked>()),
                     [&](const Message& message) {
                       const TrackedFrame& frame = std::get<FrameTracked>(message.event).frame;
                       if (frame.state == TrackingState::kTracking) first_pose = whole.ms();
                     });
  system.load_map(std::move(stored.map), {});
  const double ready = whole.ms();
  system.process(image);
  system.finish();
  reader.wait();
  if (!first_pose) throw InputError("the image to start with was not found in the map");
  note(times, "network made ready", network_ms);
  note(times, "map file read", loaded);
  note(times, "keyframes indexed, threads started", ready - loaded);
  note(times, "first image to its pose", *first_pose - ready);
  note(times, "map file to first pose", *first_pose);
  note(times, "network and map file to first pose", network_ms + *first_pose);
}

}  // namespace

void measure_start(const Map& map, const Camera& camera, const RgbdImage& image,
                   const std::function<std::unique_ptr<FeatureExtractor>()>& make_extractor,
                   const std::string& file, int runs) {
  auto extractor = make_extractor();
  const MapHeader header{extractor->name(), extractor->model_hash(), extractor->traits()};
  save_map(file, take_snapshot(header, map));
  Times times;
  for (int run = 0; run < runs; ++run) {
    const Stopwatch watch;
    extractor = make_extractor();
    const double network_ms = watch.ms();
    start_once(camera, image, std::move(extractor), network_ms, file, times);
  }
  fmt::print("\n| start in a map of {} keyframes, {} points | ms: median of {} | longest |\n",
             map.keyframe_count(), map.point_count(), runs);
  fmt::print("|---|---|---|\n");
  for (auto& [name, values] : times) {
    std::sort(values.begin(), values.end());
    fmt::print("| {} | {:.0f} | {:.0f} |\n", name, values[values.size() / 2], values.back());
  }
}

}  // namespace dxslam::benchmark
