// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "mapping/point_fusion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/triangulation.h"
#include "map/view_range.h"
#include "mapping/local_mapper.h"
#include "matching/guided_matching.h"

// How points of neighbouring keyframes are bound to each other.

namespace dxslam {
namespace {

constexpr double kMaxViewAngle = 60.0;  // degrees across which points are fused, at any distance

struct Candidates {
  std::vector<PixelPrediction> predictions;
  std::vector<PointId> points;
  cv::Mat descriptors;  // one row a prediction
};

Candidates predict(const Map& map, const std::vector<PointId>& points, const Keyframe& target,
                   const Camera& camera, float radius) {
  Candidates candidates;
  const Frame& frame = *target.frame;
  const PointPredictor predictor(camera, target.world_from_camera,
                                 {kMaxViewAngle, std::numeric_limits<double>::infinity()});
  candidates.descriptors.create(static_cast<int>(points.size()), frame.descriptors.cols,
                                frame.descriptors.type());
  for (const PointId id : points) {
    const auto place = predictor.place_of(map.point(id));
    if (!place) continue;
    const int row = static_cast<int>(candidates.points.size());
    map.descriptor_of(id).copyTo(candidates.descriptors.row(row));
    candidates.predictions.push_back({row, place->pixel.cast<float>(),
                                      radius * static_cast<float>(place->stretch),
                                      static_cast<float>(place->depth)});
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

// Within `pixels` of the raw image.
bool is_near(const Camera& camera, const Eigen::Vector3d& in_camera, const Eigen::Vector2d& pixel,
             double pixels) {
  const double most = pixels * camera.stretch(pixel);
  return camera.squared_error(in_camera, pixel) <= most * most;
}

}  // namespace

std::vector<PointId> points_seen(const Map& map, KeyframeId keyframe) {
  std::vector<PointId> points;
  for (const PointId p : map.keyframe(keyframe).points) {
    if (p != kNoId) points.push_back(p);
  }
  return points;
}

int fuse_points(const std::vector<PointId>& points, KeyframeId target_id, const PointFusion& fusion,
                Map& map) {
  const Camera& camera = map.camera_of(target_id);
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
    fused += fuse_points(points_seen(map_, keyframe), neighbour, fusion, map_);
  }
  const std::vector<PointId> points =
      points_of(map_, neighbours, std::numeric_limits<std::size_t>::max());
  return fused + fuse_points(points, keyframe, fusion, map_);
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
      const auto point = triangulate({map_.camera_of(keyframe), here.world_from_camera, pixel},
                                     {map_.camera_of(c.keyframe), there.world_from_camera, other},
                                     options_.min_parallax * std::numbers::pi / 180.0);
      if (!point) continue;
      const Eigen::Vector3d in_here = here.world_from_camera.inverse() * *point;
      const Eigen::Vector3d in_there = there.world_from_camera.inverse() * *point;
      if (!is_near(map_.camera_of(keyframe), in_here, pixel, options_.epipolar_tolerance) ||
          !is_near(map_.camera_of(c.keyframe), in_there, other, options_.epipolar_tolerance)) {
        continue;
      }
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
