// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map/map_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"

namespace dxslam {
namespace {

// The text is made only where something is wrong.
template <class... Values>
void expect(bool condition, fmt::format_string<Values...> text, Values&&... values) {
  if (!condition) throw ContractError(fmt::format(text, std::forward<Values>(values)...));
}

void check_frame(const Keyframe& k, const Frame& model) {
  expect(k.frame != nullptr, "keyframe {} has no frame", k.id);
  const Frame& frame = *k.frame;
  const std::size_t n = frame.size();
  expect(frame.depths.size() == n && frame.scores.size() == n && frame.sigmas.size() == n &&
             frame.descriptors.rows == static_cast<int>(n),
         "keyframe {} has {} keypoints, but not as many depths, scores, sigmas and descriptors",
         k.id, n);
  expect(n == 0 || model.size() == 0 ||
             (frame.descriptors.type() == model.descriptors.type() &&
              frame.descriptors.cols == model.descriptors.cols),
         "keyframe {} has descriptors of another kind than the first one", k.id);
}

// One root a component, parents of the same component, no rings.
void check_tree(const std::vector<Keyframe>& keyframes) {
  std::vector<bool> has_root(keyframes.size(), false);
  for (const Keyframe& k : keyframes) {
    expect(k.component < keyframes.size(), "keyframe {} is of component {}, expected less than {}",
           k.id, k.component, keyframes.size());
    if (k.parent == kNoId) {
      expect(!has_root[k.component], "component {} has a second keyframe without parent, {}",
             k.component, k.id);
      has_root[k.component] = true;
      continue;
    }
    expect(k.parent < keyframes.size(), "keyframe {} has the parent {}, which does not exist", k.id,
           k.parent);
    expect(keyframes[k.parent].component == k.component,
           "keyframe {} and its parent {} are of different components", k.id, k.parent);
  }
  std::vector<KeyframeId> visitor(keyframes.size(), kNoId);  // whose walk to the root passed here
  for (const Keyframe& k : keyframes) {
    for (KeyframeId id = k.id; id != kNoId && visitor[id] == kNoId; id = keyframes[id].parent) {
      visitor[id] = k.id;
      const KeyframeId parent = keyframes[id].parent;
      expect(parent == kNoId || visitor[parent] != k.id, "keyframe {} is its own ancestor", parent);
    }
  }
}

void check_keyframes(const MapParts& parts) {
  const Frame empty;
  const Frame* model = &empty;
  for (std::size_t i = 0; i < parts.keyframes.size(); ++i) {
    const Keyframe& k = parts.keyframes[i];
    expect(k.id == i, "keyframe {} has the id {}", i, k.id);
    check_frame(k, *model);
    if (model->size() == 0) model = k.frame.get();
    expect(parts.rig.has(k.frame->camera), "keyframe {} was taken by camera {} of {}", i,
           k.frame->camera, parts.rig.size());
    expect(k.world_from_camera.translation().allFinite() &&
               k.world_from_camera.rotation().coeffs().allFinite(),
           "the pose of keyframe {} is not finite", i);
  }
  check_tree(parts.keyframes);
  expect(parts.keyframes.empty() ? parts.last_keyframe == kNoId
                                 : parts.last_keyframe < parts.keyframes.size(),
         "the last keyframe, {}, does not exist", parts.last_keyframe);
}

void check_point(const MapPoint& p, std::size_t keyframes) {
  expect(p.position.allFinite() && p.normal.allFinite() && std::isfinite(p.distance),
         "the position of point {} is not finite", p.id);
  expect(p.created_by < keyframes, "point {} was made by keyframe {}, which does not exist", p.id,
         p.created_by);
  expect(p.descriptor < p.observations.size(),
         "point {} takes its descriptor from observation {} of {}", p.id, p.descriptor,
         p.observations.size());
}

}  // namespace

MapParts take_apart(const Map& map) {
  MapParts parts;
  parts.rig = map.rig();
  const std::vector<KeyframeId> ids = map.keyframe_ids();
  std::vector<KeyframeId> number(ids.empty() ? 0 : ids.back() + 1, kNoId);
  for (std::size_t i = 0; i < ids.size(); ++i) number[ids[i]] = static_cast<KeyframeId>(i);
  std::vector<std::uint32_t> component(map.component_count(), kNoId);
  std::uint32_t components = 0;

  parts.keyframes.resize(ids.size());
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const Keyframe& from = map.keyframe(ids[i]);
    Keyframe& to = parts.keyframes[i];
    to.id = static_cast<KeyframeId>(i);
    to.frame = from.frame;
    to.world_from_camera = from.world_from_camera;
    to.parent = from.parent == kNoId ? kNoId : number[from.parent];
    std::uint32_t& mine = component[from.component];
    if (mine == kNoId) mine = components++;
    to.component = mine;
  }
  if (map.last_keyframe() != kNoId) parts.last_keyframe = number[map.last_keyframe()];

  const std::vector<PointId> points = map.point_ids();
  parts.points.reserve(points.size());
  for (const PointId id : points) {
    MapPoint p = map.point(id);
    p.id = static_cast<PointId>(parts.points.size());
    p.created_by = number[map.anchor_of(p.created_by).keyframe];
    for (PointObservation& o : p.observations) o.keyframe = number[o.keyframe];
    parts.points.push_back(std::move(p));
  }
  return parts;
}

Map::Map(MapParts parts) {
  check_keyframes(parts);
  rig_ = std::move(parts.rig);
  for (Keyframe& k : parts.keyframes) {
    k.points.assign(k.frame->size(), kNoId);
    k.covisibles.clear();
    component_count_ = std::max(component_count_, k.component + 1);
    keyframes_.insert(next_keyframe_++, std::move(k));
  }
  last_keyframe_ = parts.last_keyframe;
  for (MapPoint& p : parts.points) {
    expect(p.id == points_.size(), "point {} has the id {}", points_.size(), p.id);
    check_point(p, keyframes_.size());
    bind_observations(p);
    points_.insert(next_point_++, std::move(p));
  }
  count_covisibility();
}

void Map::bind_observations(const MapPoint& p) {
  for (std::size_t i = 0; i < p.observations.size(); ++i) {
    const PointObservation& o = p.observations[i];
    expect(o.keyframe < keyframes_.size(), "point {} is seen by keyframe {}, which does not exist",
           p.id, o.keyframe);
    expect(i == 0 || p.observations[i - 1].keyframe < o.keyframe,
           "the observations of point {} are not by rising keyframe", p.id);
    Keyframe& k = mutable_keyframe(o.keyframe);
    expect(k.component == keyframe(p.observations[0].keyframe).component,
           "point {} is seen from different components", p.id);
    expect(o.keypoint < k.points.size(), "point {} is seen by keypoint {} of {} of keyframe {}",
           p.id, o.keypoint, k.points.size(), o.keyframe);
    expect(k.points[o.keypoint] == kNoId, "points {} and {} are seen by the same keypoint",
           k.points[o.keypoint], p.id);
    k.points[o.keypoint] = p.id;
  }
}

void Map::count_covisibility() {
  // The keyframes of all points one behind the other: points are visited in no order below.
  std::vector<std::size_t> first(points_.size() + 1, 0);
  std::vector<KeyframeId> seen_by;
  points_.for_each([&](PointId id, const MapPoint& p) {
    for (const PointObservation& o : p.observations) seen_by.push_back(o.keyframe);
    first[id + 1] = seen_by.size();
  });
  std::vector<int> shared(keyframes_.size(), 0);
  std::vector<KeyframeId> others;
  keyframes_.for_each([&](KeyframeId, Keyframe& k) {
    for (const PointId p : k.points) {
      if (p == kNoId) continue;
      for (std::size_t i = first[p]; i < first[p + 1]; ++i) {
        if (shared[seen_by[i]]++ == 0) others.push_back(seen_by[i]);
      }
    }
    std::sort(others.begin(), others.end());
    k.covisibles.reserve(others.size());
    for (const KeyframeId other : others) {
      if (other != k.id) k.covisibles.push_back({other, shared[other]});
      shared[other] = 0;
    }
    others.clear();
  });
}

}  // namespace dxslam
