// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "relocalization/pose_refinement.h"

#include <algorithm>
#include <cstring>
#include <unordered_map>

#include "core/area_counts.h"
#include "map/view_range.h"
#include "matching/guided_matching.h"

namespace dxslam {
namespace {

// The map point of `match` as an observation at a pose.
PoseObservation observe(const Camera& camera, const Map& map, const Frame& frame,
                        const PointMatch& match, const SE3& camera_from_world) {
  const std::size_t i = static_cast<std::size_t>(match.keypoint);
  const Eigen::Vector3d& position = map.point(match.id).position;
  return {position, measurement_of(frame, i, camera, (camera_from_world * position).z())};
}

}  // namespace

PoseRefiner::PoseRefiner(const Camera& camera, const DescriptorTraits& traits,
                         const RelocalizationOptions& options, const Map& map, const Frame& frame)
    : camera_(camera),
      traits_(traits),
      options_(options),
      map_(map),
      frame_(frame),
      grid_(frame.pixels) {}

bool PoseRefiner::refine(RefinedPose& pose) const {
  if (!optimise(pose)) return false;
  pose.reference = best_reference(pose.inliers);
  std::vector<PointId> points = local_points(pose.reference);
  search(points, options_.wide_radius, pose);
  if (!optimise(pose)) return false;
  const KeyframeId better = best_reference(pose.inliers);
  if (better != pose.reference) points = local_points(better);
  pose.inliers.clear();
  const std::vector<Eigen::Vector2f> in_view = search(points, options_.narrow_radius, pose);
  if (!optimise(pose)) return false;
  pose.reference = best_reference(pose.inliers);
  pose.visible = static_cast<int>(in_view.size());
  pose.coverage = coverage(in_view, pose.inliers);
  return true;
}

bool PoseRefiner::optimise(RefinedPose& pose) const {
  const SE3 camera_from_world = pose.world_from_camera.inverse();
  std::vector<PoseObservation> observations;
  observations.reserve(pose.inliers.size());
  for (const PointMatch& match : pose.inliers) {
    observations.push_back(observe(camera_, map_, frame_, match, camera_from_world));
  }
  const PoseReport report =
      optimize_pose(camera_, pose.world_from_camera, observations, options_.pose);
  if (!report.success) return false;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pose.inliers.size(); ++i) {
    if (report.inlier[i] != 0) pose.inliers[kept++] = pose.inliers[i];
  }
  pose.inliers.resize(kept);
  pose.world_from_camera = report.world_from_camera;
  pose.rms_pixels = report.rms_pixels;
  return true;
}

KeyframeId PoseRefiner::best_reference(const std::vector<PointMatch>& matches) const {
  std::unordered_map<KeyframeId, int> votes;
  for (const PointMatch& match : matches) {
    for (const PointObservation& o : map_.point(match.id).observations) ++votes[o.keyframe];
  }
  KeyframeId best = kNoId;
  int most = 0;
  for (const auto& [keyframe, count] : votes) {
    if (count > most || (count == most && keyframe < best)) {
      best = keyframe;
      most = count;
    }
  }
  return best;
}

std::vector<PointId> PoseRefiner::local_points(KeyframeId reference) const {
  return points_of(map_, local_keyframes(map_, reference, options_.local_map),
                   static_cast<std::size_t>(options_.local_map.max_points));
}

double PoseRefiner::coverage(const std::vector<Eigen::Vector2f>& in_view,
                             const std::vector<PointMatch>& inliers) const {
  std::vector<Eigen::Vector2f> agreeing;
  agreeing.reserve(inliers.size());
  for (const PointMatch& m : inliers) {
    agreeing.push_back(frame_.pixels[static_cast<std::size_t>(m.keypoint)]);
  }
  return agreeing_share(camera_.view(), frame_.pixels, in_view, agreeing);
}

std::vector<Eigen::Vector2f> PoseRefiner::search(const std::vector<PointId>& points, double radius,
                                                 RefinedPose& pose) const {
  std::vector<char> taken(frame_.size(), 0);
  std::vector<PointId> matched;
  for (const PointMatch& match : pose.inliers) {
    taken[static_cast<std::size_t>(match.keypoint)] = 1;
    matched.push_back(match.id);
  }
  std::sort(matched.begin(), matched.end());
  const float window = static_cast<float>(radius * camera_.width / 640.0);
  const PointPredictor predictor(camera_, pose.world_from_camera,
                                 {options_.max_view_angle, options_.max_distance_ratio});
  std::vector<PixelPrediction> predictions;
  std::vector<PointId> ids;
  std::vector<Eigen::Vector2f> in_view;
  cv::Mat descriptors(static_cast<int>(points.size()), frame_.descriptors.cols,
                      frame_.descriptors.type());
  for (const PointId id : points) {
    const auto place = predictor.place_of(map_.point(id));
    if (!place) continue;
    in_view.push_back(place->pixel.cast<float>());
    if (std::binary_search(matched.begin(), matched.end(), id)) continue;
    const int row = static_cast<int>(ids.size());
    predictions.push_back({row, in_view.back(), window * static_cast<float>(place->stretch),
                           static_cast<float>(place->depth)});
    ids.push_back(id);
    std::memcpy(descriptors.ptr(row), map_.descriptor_of(id).ptr(),
                descriptors.elemSize() * static_cast<std::size_t>(descriptors.cols));
  }
  const GuidedMatchingOptions matching{traits_.max_distance, 0.95F,
                                       static_cast<float>(options_.depth_tolerance)};
  for (const Match& m : match_guided(predictions, descriptors, frame_, grid_, taken, matching)) {
    pose.inliers.push_back({m.b, ids[static_cast<std::size_t>(m.a)]});
  }
  return in_view;
}

}  // namespace dxslam
