// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "mapping/local_mapper.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/options.h"
#include "mapping/local_bundle.h"

namespace dxslam {

LocalMapper::LocalMapper(const Camera& camera, const DescriptorTraits& traits,
                         const MappingOptions& options, Pause pause)
    : camera_(camera), traits_(traits), options_(options), pause_(std::move(pause)) {
  validate_options("mapping", options);
  camera_id_ = map_.add_camera(camera_);
}

MappingReport LocalMapper::insert(const KeyframeRequest& request) {
  pause();
  SE3 world_from_camera;
  KeyframeId parent = kNoId;
  if (request.reference != kNoId) {
    const Map::Anchor anchor = map_.anchor_of(request.reference);
    parent = anchor.keyframe;
    world_from_camera = map_.keyframe(parent).world_from_camera * anchor.anchor_from_camera *
                        request.reference_from_camera;
  }
  for (const PointCount& count : request.counts) {
    if (map_.has_point(count.point)) map_.count_visible(count.point, count.visible, count.found);
  }
  MappingReport report;
  report.keyframe = map_.add_keyframe(request.frame, world_from_camera, parent);
  bind_matches(request, report.keyframe);
  report.culled_points = cull_recent_points();
  report.new_points = create_points_from_depth(report.keyframe);
  return report;
}

void LocalMapper::refine(MappingReport& report) {
  report.fused_points = fuse_with_neighbours(report.keyframe);
  report.triangulated_points = create_points_by_triangulation(report.keyframe);
  adjust_local_bundle(report.keyframe, report);
  report.culled_keyframes = cull_keyframes(report.keyframe);
}

LocalMapPtr LocalMapper::local_map_around(KeyframeId keyframe) const {
  return make_local_map(map_, keyframe, options_.local_map);
}

void LocalMapper::bind_matches(const KeyframeRequest& request, KeyframeId keyframe) {
  for (std::size_t i = 0; i < request.points.size(); ++i) {
    const PointId point = request.points[i];
    if (!map_.has_point(point)) continue;
    if (map_.add_observation(point, keyframe, static_cast<std::uint32_t>(i)))
      map_.refresh_point(point);
  }
}

int LocalMapper::create_points_from_depth(KeyframeId keyframe) {
  const Keyframe& k = map_.keyframe(keyframe);
  int created = 0;
  for (std::size_t i = 0; i < k.frame->size(); ++i) {
    const double depth = static_cast<double>(k.frame->depths[i]);
    if (k.points[i] != kNoId || depth <= 0.0 || depth > options_.max_point_depth) continue;
    const Eigen::Vector3d in_camera =
        map_.camera_of(keyframe).unproject(k.frame->pixels[i].cast<double>(), depth);
    const PointId point =
        map_.add_point(k.world_from_camera * in_camera, keyframe, static_cast<std::uint32_t>(i));
    recent_.push_back({point, keyframe});
    ++created;
  }
  return created;
}

int LocalMapper::cull_recent_points() {
  int culled = 0;
  const KeyframeId newest = map_.last_keyframe();
  const auto judge = [&](const Recent& recent) {
    if (!map_.has_point(recent.point)) return true;  // fused away meanwhile
    const MapPoint& p = map_.point(recent.point);
    const int age = static_cast<int>(newest - recent.created_by);
    const bool rarely_found = p.found < options_.min_found_ratio * p.visible;
    const bool ended = age >= options_.probation;
    const bool lonely =
        ended && static_cast<int>(p.observations.size()) < options_.min_observations;
    if (rarely_found || lonely) {
      map_.remove_point(recent.point);
      ++culled;
      return true;
    }
    return ended;
  };
  recent_.erase(std::remove_if(recent_.begin(), recent_.end(), judge), recent_.end());
  return culled;
}

void LocalMapper::begin_recording() {
  const std::vector<KeyframeId> ids = map_.keyframe_ids();
  first_of_recording_ = ids.empty() ? 0 : ids.back() + 1;
}

// A place visited again and again must not grow each time: what a new visit adds to a known place
// has to be worth more there.
bool LocalMapper::is_redundant(const Keyframe& k) const {
  int points = 0;
  int redundant = 0;
  int known = 0;
  for (const PointId id : k.points) {
    if (id == kNoId) continue;
    ++points;
    const std::vector<PointObservation>& seen = map_.point(id).observations;
    if (static_cast<int>(seen.size()) > options_.redundant_observers) ++redundant;
    if (seen.front().keyframe < first_of_recording_) ++known;
  }
  const bool revisits = k.id >= first_of_recording_ && 2 * known > points;
  const double share = revisits ? options_.redundant_share_known : options_.redundant_share;
  return points == 0 || redundant > share * points;
}

std::vector<KeyframeId> LocalMapper::cull_keyframes(KeyframeId newest) {
  std::vector<KeyframeId> culled;
  for (const Covisible& c : std::vector<Covisible>(map_.keyframe(newest).covisibles)) {
    const Keyframe& k = map_.keyframe(c.keyframe);
    // The last few are still being matched with, the first holds the world frame.
    if (k.parent == kNoId || newest - k.id <= 2) continue;
    if (is_redundant(k)) {
      culled.push_back(k.id);
      map_.remove_keyframe(k.id);
    }
  }
  return culled;
}

int LocalMapper::adjust_full_bundle(const BundleOptions& options, const MayGoOn& may_go_on,
                                    const MapChange& change) {
  LocalBundle bundle = gather_full_bundle(map_);
  const BundleReport result = adjust_bundle(bundle.problem, options, may_go_on);
  int outliers = 0;
  if (result.usable) change([&] { outliers = apply_local_bundle(bundle, result, map_); });
  return outliers;
}

void LocalMapper::adjust_local_bundle(KeyframeId keyframe, MappingReport& report) {
  pause();
  LocalBundle bundle = gather_local_bundle(map_, keyframe, options_);
  report.bundle_keyframes = static_cast<int>(bundle.free_keyframes);
  report.bundle_points = static_cast<int>(bundle.points.size());
  report.bundle_observations = static_cast<int>(bundle.problem.observations.size());
  if (bundle.keyframes.size() < 2) return;
  const BundleReport result = adjust_bundle(bundle.problem, options_.bundle, [this] {
    pause();
    return true;
  });
  if (result.usable) report.outlier_observations = apply_local_bundle(bundle, result, map_);
}

}  // namespace dxslam
