// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "base_maps.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "core/error.h"
#include "map_files/map_merge.h"
#include "slam/map_weld.h"
#include "slam/stored_system.h"

namespace dxslam::fuzz {
namespace {

// Both ends of the first component, as if a loop had been closed there.
void add_loop(StoredMap& stored) {
  const std::vector<KeyframeId> ids = stored.map.keyframe_ids();
  const Keyframe& a = stored.map.keyframe(ids.front());
  for (auto it = ids.rbegin(); it != ids.rend(); ++it) {
    const Keyframe& b = stored.map.keyframe(*it);
    if (b.component != a.component) continue;
    stored.loops.push_back({a.id, b.id, a.world_from_camera.inverse() * b.world_from_camera});
    return;
  }
}

SystemOptions quick_options(const std::string& mode, bool hasty) {
  SystemOptions options;
  options.mode = mode;
  options.deterministic = true;
  options.extractor.deterministic = true;
  options.new_map_after = 2;
  options.tracking.min_start_points = 20;
  options.tracking.keyframe.max_translation = 0.02;
  if (!hasty) return options;
  for (BundleOptions* bundle :
       {&options.mapping.bundle, &options.loop_closing.bundle, &options.full_bundle}) {
    bundle->iterations = bundle->refine_iterations = 2;
  }
  return options;
}

}  // namespace

std::vector<RgbdImage> images_of(const Recording& recording, const std::vector<int>& numbers) {
  std::vector<RgbdImage> images;
  for (const int number : numbers) {
    RgbdImage image = recording.images()[static_cast<std::size_t>(std::max(number, 0))];
    if (number < 0) {
      image.color = image.color.clone();
      const std::int32_t nothing = -1;
      std::memcpy(image.color.data, &nothing, sizeof nothing);
    }
    image.index = static_cast<std::int64_t>(images.size());
    image.stamp = static_cast<double>(images.size()) / 10.0;
    images.push_back(std::move(image));
  }
  return images;
}

std::unique_ptr<System> make_system(const Recording& recording, const std::string& mode,
                                    bool hasty) {
  return std::make_unique<System>(recording.camera(),
                                  std::make_unique<RecordingExtractor>(-1, -1, recording),
                                  quick_options(mode, hasty));
}

BaseMaps::BaseMaps(const std::string& folder) : folder_(folder) {
  for (const Recording* recording : {&floats_, &bytes_}) {
    add(*recording, walk(*recording, {0, 2, 4, 6}));
    const StoredMap here = walk(*recording, {0, 3, 6});
    const StoredMap there = walk(*recording, {11, 8, 5});
    const std::string path = folder_ + "/merged";
    save_map(path, merge_maps(here, "here", there, "there"));
    StoredMap both = load_map(path);
    add_loop(both);
    both.thumbnails.assign(both.map.keyframe_ids().back() + std::size_t{1}, "a picture");
    add(*recording, both);
    weld_components(both);
    add(*recording, both);
  }
}

StoredMap BaseMaps::walk(const Recording& recording, const std::vector<int>& numbers) const {
  const auto system = make_system(recording, "slam");
  for (const RgbdImage& image : images_of(recording, numbers)) system->process(image);
  system->finish();
  require(system->map().keyframe_count() >= 3, "the made-up recording must make a map");
  const std::string path = folder_ + "/walk";
  save_system_map(path, map_header(system->extractor()), system->map(), system->closed_loops(), {});
  return load_map(path);
}

void BaseMaps::add(const Recording& recording, const StoredMap& map) {
  maps_.push_back({&recording, take_snapshot(map.header, map.map, map.loops, map.thumbnails)});
}

}  // namespace dxslam::fuzz
