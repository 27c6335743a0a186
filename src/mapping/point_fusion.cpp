// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "mapping/point_fusion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "geometry/triangulation.h"
#include "mapping/local_mapper.h"
#include "matching/guided_matching.h"

// How points of neighbouring keyframes are bound to each other.

namespace dxslam {
namespace {

constexpr double kMinViewCosine = 0.5;  // points are not fused across more than 60 degrees

struct Candidates {
  std::vector<PixelPrediction> predictions;
  std::vector<PointId> points;
  cv::Mat descriptors;  // one row a prediction
};

Candidates predict(const Map& map, const std::vector<PointId>& points, const Keyframe& target,
                   const Camera& camera, float radius) {
  Candidates candidates;
  const Frame& frame = *target.frame;
  const SE3 camera_from_world = target.world_from_camera.inverse();
  candidates.descriptors.create(static_cast<int>(points.size()), frame.descriptors.cols,
                                frame.descriptors.type());
  for (const PointId id : points) {
    const MapPoint& p = map.point(id);
    const Eigen::Vector3d in_camera = camera_from_world * p.position;
    const std::optional<Eigen::Vector2d> pixel = camera.project_into_view(in_camera);
    if (!pixel) continue;
    const Eigen::Vector3d ray = target.world_from_camera.translation() - p.position;
    if (ray.dot(p.normal) < kMinViewCosine * ray.norm()) continue;
    const int row = static_cast<int>(candidates.points.size());
    map.descriptor_of(id).copyTo(candidates.descriptors.row(row));
    candidates.predictions.push_back(
        {row, pixel->cast<float>(), radius, static_cast<float>(in_camera.z())});
    candidates.points.push_back(id);
  }
  return candidates;
}

bool sees(const MapPoint& point, KeyframeId keyframe) {
  return std::any_of(point.observations.begin(), point.observations.end(),
                     [&](const PointObservation& o) { return o.keyframe == keyframe; });
}

// Keypoints that could get a point by triangulation: of a keyframe, those without one.
std::vector<int> free_keypoints(const Keyframe& keyframe, bool without_depth_only) {
  std::vector<int> free;
  for (std::size_t i = 0; i < keyframe.points.size(); ++i) {
    if (keyframe.points[i] != kNoId) continue;
    if (without_depth_only && keyframe.frame->has_depth(i)) continue;
    free.push_back(static_cast<int>(i));
  }
  return free;
}

cv::Mat rows_of(const cv::Mat& descriptors, const std::vector<int>& rows) {
  cv::Mat selected(static_cast<int>(rows.size()), descriptors.cols, descriptors.type());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    descriptors.row(rows[i]).copyTo(selected.row(static_cast<int>(i)));
  }
  return selected;
}

}  // namespace

std::vector<PointId> points_seen(const Map& map, KeyframeId keyframe) {
  std::vector<PointId> points;
  for (const PointId p : map.keyframe(keyframe).points) {
    if (p != kNoId) points.push_back(p);
  }
  return points;
}

int fuse_points(const std::vector<PointId>& points, KeyframeId target_id, const Camera& camera,
                const PointFusion& fusion, Map& map) {
  const Keyframe& target = map.keyframe(target_id);
  std::vector<PointId> unseen;
  for (const PointId p : points) {
    if (map.has_point(p) && !sees(map.point(p), target_id)) unseen.push_back(p);
  }
  const float radius = static_cast<float>(fusion.radius * camera.width / 640.0);
  const Candidates candidates = predict(map, unseen, target, camera, radius);
  const KeypointGrid grid(target.frame->pixels);
  const GuidedMatchingOptions matching{fusion.traits.max_distance, static_cast<float>(fusion.ratio),
                                       static_cast<float>(fusion.depth_tolerance)};
  int fused = 0;
  for (const Match& m : match_guided(candidates.predictions, candidates.descriptors, *target.frame,
                                     grid, {}, matching)) {
    const PointId point = candidates.points[static_cast<std::size_t>(m.a)];
    if (!map.has_point(point)) continue;  // merged by an earlier match
    const PointId present = target.points[static_cast<std::size_t>(m.b)];
    if (present == kNoId) {
      if (!map.add_observation(point, target_id, static_cast<std::uint32_t>(m.b))) continue;
      map.refresh_point(point);
    } else if (present != point) {
      const bool keep_present =
          map.point(present).observations.size() >= map.point(point).observations.size();
      map.merge_points(keep_present ? point : present, keep_present ? present : point);
    }
    ++fused;
  }
  return fused;
}

int LocalMapper::fuse_with_neighbours(KeyframeId keyframe) {
  std::vector<KeyframeId> neighbours = local_keyframes(map_, keyframe, options_.local_map);
  neighbours.erase(neighbours.begin());
  if (neighbours.size() > static_cast<std::size_t>(options_.fuse_keyframes)) {
    neighbours.resize(static_cast<std::size_t>(options_.fuse_keyframes));
  }
  const PointFusion fusion{options_.fuse_radius, options_.fuse_ratio, options_.fuse_depth_tolerance,
                           traits_};
  int fused = 0;
  for (const KeyframeId neighbour : neighbours) {
    pause();
    fused += fuse_points(points_seen(map_, keyframe), neighbour, camera_, fusion, map_);
  }
  std::vector<PointId> points;
  for (const KeyframeId neighbour : neighbours) {
    const std::vector<PointId> seen = points_seen(map_, neighbour);
    points.insert(points.end(), seen.begin(), seen.end());
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return fused + fuse_points(points, keyframe, camera_, fusion, map_);
}

int LocalMapper::create_points_by_triangulation(KeyframeId keyframe) {
  int created = 0;
  const Keyframe& here = map_.keyframe(keyframe);
  for (const Covisible& c : map_.best_covisibles(
           keyframe, static_cast<std::size_t>(options_.triangulation_keyframes), 10)) {
    pause();
    const Keyframe& there = map_.keyframe(c.keyframe);
    const std::vector<int> mine = free_keypoints(here, true);
    const std::vector<int> theirs = free_keypoints(there, false);
    for (const Match& m :
         match_mutual(rows_of(here.frame->descriptors, mine),
                      rows_of(there.frame->descriptors, theirs), traits_.max_distance, 0.9F)) {
      const auto i = static_cast<std::size_t>(mine[static_cast<std::size_t>(m.a)]);
      const auto j = static_cast<std::size_t>(theirs[static_cast<std::size_t>(m.b)]);
      const Eigen::Vector2d pixel = here.frame->pixels[i].cast<double>();
      const Eigen::Vector2d other = there.frame->pixels[j].cast<double>();
      const auto point =
          triangulate(camera_, here.world_from_camera, pixel, there.world_from_camera, other,
                      options_.min_parallax * std::numbers::pi / 180.0);
      if (!point) continue;
      const Eigen::Vector3d in_here = here.world_from_camera.inverse() * *point;
      const Eigen::Vector3d in_there = there.world_from_camera.inverse() * *point;
      if ((camera_.project(in_here) - pixel).norm() > options_.epipolar_tolerance) continue;
      if ((camera_.project(in_there) - other).norm() > options_.epipolar_tolerance) continue;
      const PointId id = map_.add_point(*point, keyframe, static_cast<std::uint32_t>(i));
      map_.add_observation(id, c.keyframe, static_cast<std::uint32_t>(j));
      map_.refresh_point(id);
      recent_.push_back({id, keyframe});
      ++created;
    }
  }
  return created;
}

}  // namespace dxslam
