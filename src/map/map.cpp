// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map/map.h"

#include <algorithm>

#include "core/error.h"
#include "matching/descriptor_distance.h"

namespace dxslam {
namespace {

constexpr std::size_t kDescriptorSamples = 8;

template <class Container>
auto lower_by_keyframe(Container& sorted, KeyframeId id) {
  return std::lower_bound(sorted.begin(), sorted.end(), id,
                          [](const auto& entry, KeyframeId key) { return entry.keyframe < key; });
}

void add_shared(std::vector<Covisible>& covisibles, KeyframeId other, int change) {
  const auto it = lower_by_keyframe(covisibles, other);
  if (it == covisibles.end() || it->keyframe != other) {
    covisibles.insert(it, {other, change});
  } else if ((it->shared += change) <= 0) {
    covisibles.erase(it);
  }
}

}  // namespace

const Keyframe& Map::keyframe(KeyframeId id) const {
  const Keyframe* keyframe = keyframes_.find(id);
  require(keyframe != nullptr, "the map has no keyframe of this id");
  return *keyframe;
}

const MapPoint& Map::point(PointId id) const {
  const MapPoint* point = points_.find(id);
  require(point != nullptr, "the map has no point of this id");
  return *point;
}

Keyframe& Map::mutable_keyframe(KeyframeId id) { return const_cast<Keyframe&>(keyframe(id)); }
MapPoint& Map::mutable_point(PointId id) { return const_cast<MapPoint&>(point(id)); }

KeyframeId Map::add_keyframe(FramePtr frame, const SE3& world_from_camera, KeyframeId parent) {
  require(frame != nullptr, "a keyframe needs a frame");
  require(parent == kNoId || has_keyframe(parent), "the parent of a keyframe must be in the map");
  require(next_keyframe_ != kNoId, "the map has given all ids that there are to keyframes");
  Keyframe keyframe;
  keyframe.id = next_keyframe_++;
  keyframe.points.assign(frame->size(), kNoId);
  keyframe.frame = std::move(frame);
  keyframe.world_from_camera = world_from_camera;
  keyframe.parent = parent;
  keyframe.component = parent == kNoId ? component_count_++ : this->keyframe(parent).component;
  last_keyframe_ = keyframe.id;
  keyframes_.insert(last_keyframe_, std::move(keyframe));
  keyframe_journal_.add(last_keyframe_);
  return last_keyframe_;
}

PointId Map::add_point(const Eigen::Vector3d& position, KeyframeId keyframe,
                       std::uint32_t keypoint) {
  MapPoint point;
  const PointId id = point.id = points_.free_from(next_point_);
  next_point_ = id + 1;
  point.position = position;
  point.created_by = keyframe;
  point.visible = point.found = 1;
  points_.insert(id, std::move(point));
  point_journal_.add(id);
  require(add_observation(id, keyframe, keypoint), "the keypoint of a new point must be free");
  refresh_point(id);
  return id;
}

void Map::change_covisibility(const MapPoint& point, KeyframeId keyframe, int change) {
  for (const PointObservation& o : point.observations) {
    if (o.keyframe == keyframe) continue;
    add_shared(mutable_keyframe(o.keyframe).covisibles, keyframe, change);
    add_shared(mutable_keyframe(keyframe).covisibles, o.keyframe, change);
  }
}

bool Map::add_observation(PointId point, KeyframeId keyframe, std::uint32_t keypoint) {
  Keyframe& k = mutable_keyframe(keyframe);
  MapPoint& p = mutable_point(point);
  require(keypoint < k.points.size(), "the keyframe has no keypoint of this index");
  const auto it = lower_by_keyframe(p.observations, keyframe);
  const bool seen = it != p.observations.end() && it->keyframe == keyframe;
  if (k.points[keypoint] != kNoId || seen) return false;
  change_covisibility(p, keyframe, +1);
  const auto position = static_cast<std::uint32_t>(it - p.observations.begin());
  if (!p.observations.empty() && position <= p.descriptor) ++p.descriptor;
  p.observations.insert(it, {keyframe, keypoint});
  k.points[keypoint] = point;
  return true;
}

void Map::remove_observation(PointId point, KeyframeId keyframe) {
  MapPoint& p = mutable_point(point);
  const auto it = lower_by_keyframe(p.observations, keyframe);
  require(it != p.observations.end() && it->keyframe == keyframe,
          "the keyframe does not see the point");
  mutable_keyframe(keyframe).points[it->keypoint] = kNoId;
  const auto position = static_cast<std::uint32_t>(it - p.observations.begin());
  p.observations.erase(it);
  change_covisibility(p, keyframe, -1);
  if (p.observations.empty()) {
    points_.erase(point);
    point_journal_.remove(point);
    return;
  }
  if (position < p.descriptor) --p.descriptor;
  if (position == p.descriptor) p.descriptor = 0;
}

void Map::remove_point(PointId point) {
  const std::vector<PointObservation> observations = this->point(point).observations;
  for (const PointObservation& o : observations) remove_observation(point, o.keyframe);
}

void Map::merge_points(PointId from, PointId to) {
  if (from == to) return;
  const MapPoint source = point(from);
  require(has_point(to), "the map has no point of this id");
  remove_point(from);
  for (const PointObservation& o : source.observations) add_observation(to, o.keyframe, o.keypoint);
  count_visible(to, source.visible, source.found);
  refresh_point(to);
}

void Map::remove_keyframe(KeyframeId id) {
  const Keyframe& k = keyframe(id);
  require(k.parent != kNoId, "the first keyframe of a component cannot be removed");
  for (const PointId p : std::vector<PointId>(k.points)) {
    if (p != kNoId) remove_observation(p, id);
  }
  removed_.add(id,
               {k.parent, keyframe(k.parent).world_from_camera.inverse() * k.world_from_camera});
  keyframes_.for_each([&](KeyframeId, Keyframe& other) {
    if (other.parent == id) other.parent = k.parent;
  });
  if (last_keyframe_ == id) last_keyframe_ = k.parent;
  keyframes_.erase(id);
  keyframe_journal_.remove(id);
}

void Map::join_components(KeyframeId parent, KeyframeId child,
                          const SE3& parent_world_from_child_world) {
  const std::uint32_t from = keyframe(child).component;
  const std::uint32_t into = keyframe(parent).component;
  require(from != into, "the keyframes to join must be of different components");
  // Turn the tree around: every ancestor of `child` becomes its descendant.
  KeyframeId above = parent;
  for (KeyframeId id = child; id != kNoId;) {
    const KeyframeId next = keyframe(id).parent;
    mutable_keyframe(id).parent = above;
    above = id;
    id = next;
  }
  keyframes_.for_each([&](KeyframeId, Keyframe& k) {
    if (k.component != from) return;
    k.component = into;
    k.world_from_camera = parent_world_from_child_world * k.world_from_camera;
    keyframe_journal_.move(k.id);
    for (const PointId id : k.points) {
      if (id == kNoId) continue;
      MapPoint& p = *points_.find(id);
      // A point is moved once, by the first keyframe that sees it.
      if (p.observations.front().keyframe != k.id) continue;
      p.position = parent_world_from_child_world * p.position;
      point_journal_.move(id);
      p.normal = parent_world_from_child_world.rotation() * p.normal;
    }
  });
}

cv::Mat Map::descriptor_of(PointId id) const {
  const MapPoint& p = point(id);
  const PointObservation& seen = p.observations[p.descriptor];
  return keyframe(seen.keyframe).frame->descriptors.row(static_cast<int>(seen.keypoint));
}

void Map::set_pose(KeyframeId id, const SE3& world_from_camera) {
  mutable_keyframe(id).world_from_camera = world_from_camera;
  keyframe_journal_.move(id);
}

void Map::set_position(PointId id, const Eigen::Vector3d& position) {
  mutable_point(id).position = position;
  point_journal_.move(id);
}

MapChanges Map::take_changes() {
  MapChanges changes;
  keyframe_journal_.take(changes.added_keyframes, changes.moved_keyframes,
                         changes.removed_keyframes);
  point_journal_.take(changes.added_points, changes.moved_points, changes.removed_points);
  return changes;
}

void Map::count_visible(PointId id, std::uint32_t visible, std::uint32_t found) {
  MapPoint& p = mutable_point(id);
  p.visible += visible;
  p.found += found;
}

void Map::refresh_point(PointId id) {
  MapPoint& p = mutable_point(id);
  p.normal.setZero();
  std::vector<float> distances;
  for (const PointObservation& o : p.observations) {
    const Eigen::Vector3d ray = keyframe(o.keyframe).world_from_camera.translation() - p.position;
    const double norm = ray.norm();
    if (norm > 0.0) p.normal += ray / norm;
    distances.push_back(static_cast<float>(norm));
  }
  if (p.normal.norm() > 0.0) p.normal.normalize();
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  p.distance = *middle;

  const std::size_t n = p.observations.size();
  const std::size_t samples = std::min(n, kDescriptorSamples);
  float best = std::numeric_limits<float>::max();
  for (std::size_t s = 0; s < samples; ++s) {
    const PointObservation& a = p.observations[s * n / samples];
    float sum = 0.0F;
    for (std::size_t t = 0; t < samples; ++t) {
      const PointObservation& b = p.observations[t * n / samples];
      sum += descriptor_distance(
          keyframe(a.keyframe).frame->descriptors, static_cast<int>(a.keypoint),
          keyframe(b.keyframe).frame->descriptors, static_cast<int>(b.keypoint));
    }
    if (sum < best) {
      best = sum;
      p.descriptor = static_cast<std::uint32_t>(s * n / samples);
    }
  }
}

std::vector<KeyframeId> Map::keyframe_ids() const {
  std::vector<KeyframeId> ids;
  ids.reserve(keyframes_.size());
  keyframes_.for_each([&](KeyframeId id, const Keyframe&) { ids.push_back(id); });
  return ids;
}

std::vector<PointId> Map::point_ids() const {
  std::vector<PointId> ids;
  ids.reserve(points_.size());
  points_.for_each([&](PointId id, const MapPoint&) { ids.push_back(id); });
  return ids;
}

std::vector<Covisible> Map::best_covisibles(KeyframeId id, std::size_t n, int min_shared) const {
  std::vector<Covisible> best;
  for (const Covisible& c : keyframe(id).covisibles) {
    if (c.shared >= min_shared) best.push_back(c);
  }
  std::sort(best.begin(), best.end(), [](const Covisible& a, const Covisible& b) {
    return a.shared != b.shared ? a.shared > b.shared : a.keyframe > b.keyframe;
  });
  if (best.size() > n) best.resize(n);
  return best;
}

Map::Anchor Map::anchor_of(KeyframeId id) const {
  require(id < next_keyframe_, "the map never had a keyframe of this id");
  Anchor anchor{id, SE3()};
  while (!has_keyframe(anchor.keyframe)) {
    const RemovedKeyframes::Place removed = removed_.find(anchor.keyframe);
    anchor.anchor_from_camera = removed.parent_from_camera * anchor.anchor_from_camera;
    anchor.keyframe = removed.parent;
  }
  return anchor;
}

}  // namespace dxslam
