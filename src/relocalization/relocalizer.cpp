// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "relocalization/relocalizer.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/options.h"
#include "relocalization/confidence.h"
#include "relocalization/group_matching.h"
#include "relocalization/keyframe_groups.h"
#include "relocalization/pose_refinement.h"

namespace dxslam {
namespace {

double spread_of(const Camera& camera, const Frame& frame, const std::vector<PointMatch>& matches) {
  if (matches.size() < 2) return 0.0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const PointMatch& m : matches) {
    mean += frame.pixels[static_cast<std::size_t>(m.keypoint)].cast<double>();
  }
  mean /= static_cast<double>(matches.size());
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  for (const PointMatch& m : matches) {
    const Eigen::Vector2d d =
        frame.pixels[static_cast<std::size_t>(m.keypoint)].cast<double>() - mean;
    covariance += d * d.transpose();
  }
  covariance /= static_cast<double>(matches.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()(0))) /
         std::hypot(camera.width, camera.height);
}

// One attempt: a frame against one group.
class GroupAttempt {
 public:
  GroupAttempt(const Camera& camera, const DescriptorTraits& traits,
               const RelocalizationOptions& options, const Map& map, const Frame& frame)
      : camera_(camera),
        traits_(traits),
        options_(options),
        map_(map),
        frame_(frame),
        refiner_(camera, traits, options, map, frame) {}

  RelocalizationReport run(const CandidateGroup& group) const {
    RelocalizationReport report;
    report.component = group.component;
    const GroupPoints points =
        gather_group_points(map_, group.keyframes, options_.descriptors_per_point,
                            options_.max_group_rows, traits_.max_distance);
    const std::vector<GroupMatch> matches =
        match_group(frame_.descriptors, options_.max_keypoints, points, traits_.max_distance,
                    static_cast<float>(options_.match_ratio));
    report.matches = static_cast<int>(matches.size());
    if (report.matches < options_.min_matches) return report;
    RefinedPose pose;
    if (!find_pose(points, matches, pose) || !refiner_.refine(pose)) return report;
    fill_in(points, matches, pose, report);
    return report;
  }

 private:
  bool find_pose(const GroupPoints& points, const std::vector<GroupMatch>& matches,
                 RefinedPose& pose) const {
    std::vector<Eigen::Vector3d> positions;
    std::vector<Eigen::Vector2d> pixels;
    std::vector<float> depths;
    for (const GroupMatch& m : matches) {
      const std::size_t k = static_cast<std::size_t>(m.keypoint);
      positions.push_back(points.positions[static_cast<std::size_t>(m.point)]);
      pixels.push_back(frame_.pixels[k].cast<double>());
      depths.push_back(frame_.depths[k]);
    }
    PnpOptions pnp = options_.pnp;
    pnp.threshold *= camera_.width / 640.0;
    const std::optional<PnpReport> found = solve_pnp(camera_, positions, pixels, depths, pnp);
    if (!found) return false;
    pose.world_from_camera = found->world_from_camera;
    for (std::size_t i = 0; i < matches.size(); ++i) {
      if (found->inlier[i] == 0) continue;
      pose.inliers.push_back(
          {matches[i].keypoint, points.ids[static_cast<std::size_t>(matches[i].point)]});
    }
    return true;
  }

  void fill_in(const GroupPoints& points, const std::vector<GroupMatch>& matches,
               const RefinedPose& pose, RelocalizationReport& report) const {
    report.has_pose = true;
    report.world_from_camera = pose.world_from_camera;
    report.reference = pose.reference;
    report.visible = pose.visible;
    report.inliers = static_cast<int>(pose.inliers.size());
    report.coverage = pose.coverage;
    report.rms_pixels = pose.rms_pixels;
    report.spread = spread_of(camera_, frame_, pose.inliers);
    report.points.assign(frame_.size(), kNoId);
    for (const PointMatch& m : pose.inliers) {
      report.points[static_cast<std::size_t>(m.keypoint)] = m.id;
    }
    report.matched = count_matched(points, matches, pose.world_from_camera);
    report.confidence = relocalization_confidence(report);
    const AcceptanceOptions& least = options_.acceptance;
    report.accepted = report.matched >= least.min_matched && report.inliers >= least.min_inliers &&
                      report.ratio() >= least.min_ratio && report.spread >= least.min_spread &&
                      report.coverage >= least.min_coverage &&
                      report.confidence >= least.min_confidence;
  }

  // Unlike the inliers, these were found without knowing the pose: the stronger evidence.
  int count_matched(const GroupPoints& points, const std::vector<GroupMatch>& matches,
                    const SE3& world_from_camera) const {
    const SE3 camera_from_world = world_from_camera.inverse();
    const double threshold = options_.pnp.threshold * camera_.width / 640.0;
    int matched = 0;
    for (const GroupMatch& m : matches) {
      const std::size_t k = static_cast<std::size_t>(m.keypoint);
      const Eigen::Vector3d p =
          camera_from_world * points.positions[static_cast<std::size_t>(m.point)];
      const Eigen::Vector2d pixel = frame_.pixels[k].cast<double>();
      const double within = threshold * camera_.stretch(pixel);
      if (camera_.squared_error(p, pixel) > within * within) continue;
      const double depth = static_cast<double>(frame_.depths[k]);
      if (frame_.has_depth(k) && std::abs(p.z() - depth) > options_.depth_tolerance * p.z())
        continue;
      ++matched;
    }
    return matched;
  }

  const Camera& camera_;
  const DescriptorTraits& traits_;
  const RelocalizationOptions& options_;
  const Map& map_;
  const Frame& frame_;
  PoseRefiner refiner_;
};

}  // namespace

Relocalizer::Relocalizer(const Camera& camera, const DescriptorTraits& traits,
                         const RelocalizationOptions& options)
    : camera_(camera), traits_(traits), options_(options) {
  camera_.prepare("calibration");
  validate_options("relocalization", options);
}

RelocalizationReport Relocalizer::relocalize(const Map& map, const GlobalIndex& index,
                                             const Frame& frame) const {
  return relocalize(map, index.query(frame.global, static_cast<std::size_t>(options_.candidates)),
                    frame);
}

RelocalizationReport Relocalizer::relocalize(const Map& map,
                                             const std::vector<GlobalMatch>& candidates,
                                             const Frame& frame) const {
  const std::vector<CandidateGroup> groups = group_by_covisibility(
      map, candidates, options_.min_shared, static_cast<std::size_t>(options_.group_keyframes));
  const GroupAttempt attempt(camera_, traits_, options_, map, frame);
  RelocalizationReport best;
  int tried = 0;
  for (const CandidateGroup& group : groups) {
    if (tried == options_.max_groups) break;
    ++tried;
    RelocalizationReport report = attempt.run(group);
    const bool better =
        report.has_pose != best.has_pose ? report.has_pose : report.confidence > best.confidence;
    if (better || (!report.has_pose && !best.has_pose && report.matches > best.matches)) {
      best = std::move(report);
    }
    if (best.accepted) break;
  }
  best.groups_tried = tried;
  return best;
}

GlobalIndex index_keyframes(const Map& map) {
  GlobalIndex index;
  for (const KeyframeId id : map.keyframe_ids()) {
    const std::vector<float>& global = map.keyframe(id).frame->global;
    if (!global.empty()) index.add(id, global);
  }
  return index;
}

}  // namespace dxslam
