// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "large_map.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <unordered_map>

namespace dxslam::benchmark {
namespace {

constexpr float kGlobalNoise = 0.5F;  // length of the noise added to a unit vector

FramePtr altered(const Frame& frame, const std::vector<int>& order, std::mt19937& random) {
  auto copy = std::make_shared<Frame>(frame);
  copy->descriptors = cv::Mat(frame.descriptors.size(), frame.descriptors.type());
  for (std::size_t d = 0; d < order.size(); ++d) {
    frame.descriptors.col(order[d]).copyTo(copy->descriptors.col(static_cast<int>(d)));
  }
  std::normal_distribution<float> noise(
      0.0F,
      kGlobalNoise / std::sqrt(static_cast<float>(std::max<std::size_t>(1, frame.global.size()))));
  float square = 0.0F;
  for (float& x : copy->global) {
    x += noise(random);
    square += x * x;
  }
  for (float& x : copy->global) x /= std::sqrt(square);
  return copy;
}

// Parents come before their children in `order`.
std::vector<KeyframeId> by_tree(const Map& map) {
  std::vector<KeyframeId> order, rest = map.keyframe_ids();
  std::vector<KeyframeId> done = {kNoId};
  while (!rest.empty()) {
    std::vector<KeyframeId> later;
    for (const KeyframeId id : rest) {
      if (std::find(done.begin(), done.end(), map.keyframe(id).parent) != done.end()) {
        order.push_back(id);
        done.push_back(id);
      } else {
        later.push_back(id);
      }
    }
    rest = std::move(later);
  }
  return order;
}

void append(const Map& map, bool alter, std::mt19937& random, Map& large) {
  std::unordered_map<KeyframeId, KeyframeId> new_id = {{kNoId, kNoId}};
  std::vector<int> order(
      static_cast<std::size_t>(map.keyframe(map.keyframe_ids().front()).frame->descriptors.cols));
  std::iota(order.begin(), order.end(), 0);
  if (alter) std::shuffle(order.begin(), order.end(), random);
  for (const KeyframeId id : by_tree(map)) {
    const Keyframe& k = map.keyframe(id);
    new_id[id] = large.add_keyframe(alter ? altered(*k.frame, order, random) : k.frame,
                                    k.world_from_camera, new_id.at(k.parent));
  }
  for (const PointId id : map.point_ids()) {
    const MapPoint& p = map.point(id);
    const PointObservation& first = p.observations.front();
    const PointId added = large.add_point(p.position, new_id.at(first.keyframe), first.keypoint);
    for (const PointObservation& o : p.observations) {
      if (o.keyframe != first.keyframe) {
        large.add_observation(added, new_id.at(o.keyframe), o.keypoint);
      }
    }
    large.refresh_point(added);
  }
}

}  // namespace

Map enlarge_map(const Map& map, std::size_t keyframes) {
  std::mt19937 random(1);
  Map large;
  append(map, false, random, large);
  while (large.keyframe_count() < keyframes) append(map, true, random, large);
  return large;
}

}  // namespace dxslam::benchmark
