// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "loop_closing/loop_verification.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/area_counts.h"
#include "core/error.h"
#include "loop_closing/keyframe_group.h"
#include "map/view_range.h"
#include "matching/guided_matching.h"

namespace dxslam {
namespace {

constexpr double kMaxViewAngle = 60.0;  // degrees; farther round, a point is taken for unseen
constexpr double kMaxDistanceRatio = 2.5;
constexpr int kMinExpected = 40;  // points in view of a neighbour that is worth asking

int shared_points(const Keyframe& keyframe, KeyframeId other) {
  for (const Covisible& c : keyframe.covisibles) {
    if (c.keyframe == other) return c.shared;
  }
  return 0;
}

class LoopVerifier {
 public:
  LoopVerifier(const Map& map, const DescriptorTraits& traits,
               const LoopVerificationOptions& options)
      : map_(map), traits_(traits), options_(options) {}

  LoopVerification run(KeyframeId query, KeyframeId candidate) {
    report_.query = query;
    report_.candidate = candidate;
    using Step = LoopRejection (LoopVerifier::*)();
    constexpr std::array<Step, 6> kSteps = {&LoopVerifier::gather,   &LoopVerifier::match,
                                            &LoopVerifier::estimate, &LoopVerifier::refine,
                                            &LoopVerifier::judge,    &LoopVerifier::confirm};
    for (const Step step : kSteps) {
      report_.rejection = (this->*step)();
      if (report_.rejection != LoopRejection::kNone) return report_;
    }
    report_.accepted = true;
    report_.candidate_from_query =
        map_.keyframe(candidate).world_from_camera.inverse() * world_from_query_;
    return report_;
  }

 private:
  LoopRejection gather() {
    require(map_.has_keyframe(report_.query), "the query of a loop must be in the map");
    if (!map_.has_keyframe(report_.candidate)) return LoopRejection::kGone;
    const Keyframe& query = map_.keyframe(report_.query);
    if (report_.query == report_.candidate ||
        shared_points(query, report_.candidate) >= options_.max_shared) {
      return LoopRejection::kConnected;
    }
    const KeyframeGroup group =
        gather_group(map_, report_.candidate, static_cast<std::size_t>(options_.group_keyframes),
                     options_.group_min_shared, static_cast<std::size_t>(options_.max_points));
    std::vector<PointId> own = query.points;
    std::sort(own.begin(), own.end());
    for (const PointId p : group.points) {
      // What the query sees already would confirm the map's own belief, right or wrong.
      if (!std::binary_search(own.begin(), own.end(), p)) points_.push_back(p);
    }
    descriptors_.create(static_cast<int>(points_.size()), query.frame->descriptors.cols,
                        query.frame->descriptors.type());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      map_.descriptor_of(points_[i]).copyTo(descriptors_.row(static_cast<int>(i)));
    }
    report_.points = static_cast<int>(points_.size());
    return report_.points < options_.min_matches ? LoopRejection::kFewPoints : LoopRejection::kNone;
  }

  LoopRejection match() {
    // Points in the first place: one that is in the map twice must not spoil the ratio test.
    matches_ = match_mutual(descriptors_, query_frame().descriptors, traits_.max_distance,
                            static_cast<float>(options_.ratio));
    report_.matches = static_cast<int>(matches_.size());
    return report_.matches < options_.min_matches ? LoopRejection::kFewMatches
                                                  : LoopRejection::kNone;
  }

  LoopRejection estimate() {
    const Frame& frame = query_frame();
    std::vector<Eigen::Vector3d> positions;
    std::vector<Eigen::Vector2d> pixels;
    std::vector<float> depths;
    for (const Match& m : matches_) {
      positions.push_back(point(m.a).position);
      pixels.push_back(frame.pixels[static_cast<std::size_t>(m.b)].cast<double>());
      depths.push_back(frame.depths[static_cast<std::size_t>(m.b)]);
    }
    const std::optional<PnpReport> pnp =
        solve_pnp(query_camera(), positions, pixels, depths, options_.pnp);
    if (!pnp) return LoopRejection::kNoPose;
    report_.pose_inliers = pnp->inliers;
    world_from_query_ = pnp->world_from_camera;
    return LoopRejection::kNone;
  }

  LoopRejection refine() {
    for (const double share : {1.0, 0.5}) {
      fit_ = fit(report_.query, world_from_query_, share * options_.search_radius);
      report_.expected = static_cast<int>(fit_.predictions.size());
      report_.guided_matches = static_cast<int>(fit_.matches.size());
      if (!fit_.pose.success) return LoopRejection::kNoPose;
      world_from_query_ = fit_.pose.world_from_camera;
    }
    report_.inliers = fit_.pose.inliers;
    report_.rms_pixels = fit_.pose.rms_pixels;
    return LoopRejection::kNone;
  }

  LoopRejection judge() {
    collect_inliers();
    report_.scale = scale();
    report_.found_share = found_share(report_.inliers, report_.expected, query_frame());
    report_.depth_share = depth_share();
    if (report_.inliers < options_.min_inliers) return LoopRejection::kFewInliers;
    if (report_.inliers < options_.min_inlier_ratio * report_.guided_matches) {
      return LoopRejection::kManyOutliers;
    }
    if (report_.found_share < options_.min_found_share) return LoopRejection::kFewFound;
    if (report_.cells < options_.min_cells || report_.covered_share < options_.min_covered_share) {
      return LoopRejection::kNarrow;
    }
    if (report_.depth_share < options_.min_depth_share) return LoopRejection::kDepth;
    return LoopRejection::kNone;
  }

  // A pose that only one image speaks for is chance or a picture on another wall.
  LoopRejection confirm() {
    const SE3 query_from_world = map_.keyframe(report_.query).world_from_camera.inverse();
    for (const Covisible& c : map_.best_covisibles(
             report_.query, static_cast<std::size_t>(options_.confirming_keyframes),
             options_.group_min_shared)) {
      const Keyframe& neighbour = map_.keyframe(c.keyframe);
      const SE3 query_from_neighbour = query_from_world * neighbour.world_from_camera;
      const SE3 as_long_as_there(query_from_neighbour.rotation(),
                                 report_.scale * query_from_neighbour.translation());
      const Fit seen =
          fit(c.keyframe, world_from_query_ * as_long_as_there, options_.search_radius);
      const int expected = static_cast<int>(seen.predictions.size());
      if (expected < kMinExpected) continue;
      ++report_.confirming;
      if (seen.pose.success && seen.pose.inliers >= options_.pnp.min_inliers &&
          found_share(seen.pose.inliers, expected, *neighbour.frame) >= options_.min_found_share) {
        ++report_.confirmations;
      }
    }
    return report_.confirmations < std::min(options_.min_confirmations, report_.confirming)
               ? LoopRejection::kUnconfirmed
               : LoopRejection::kNone;
  }

  /// The points sought in a frame from a pose near the true one.
  struct Fit {
    std::vector<PixelPrediction> predictions;  // of the points that should be in view
    std::vector<Match> matches;                // a: row of the point, b: keypoint
    PoseReport pose;                           // as refined on the matches
  };

  Fit fit(KeyframeId keyframe, const SE3& world_from_camera, double radius) const {
    const Frame& frame = *map_.keyframe(keyframe).frame;
    const Camera& camera = map_.camera_of(keyframe);
    Fit fit;
    fit.predictions = predict(camera, world_from_camera, radius);
    const KeypointGrid grid(frame.pixels);
    const GuidedMatchingOptions matching{traits_.max_distance,
                                         static_cast<float>(options_.search_ratio), 0.0F};
    fit.matches = match_guided(fit.predictions, descriptors_, frame, grid, {}, matching);
    for (Match& m : fit.matches) {
      m.a = fit.predictions[static_cast<std::size_t>(m.a)].descriptor_row;
    }
    fit.pose =
        optimize_pose(camera, world_from_camera,
                      observations(frame, camera, world_from_camera, fit.matches), options_.pose);
    return fit;
  }

  const Frame& query_frame() const { return *map_.keyframe(report_.query).frame; }
  const Camera& query_camera() const { return map_.camera_of(report_.query); }
  const MapPoint& point(int row) const {
    return map_.point(points_[static_cast<std::size_t>(row)]);
  }

  // Depths are left out of the search, so that they can bear witness afterwards.
  std::vector<PixelPrediction> predict(const Camera& camera, const SE3& world_from_camera,
                                       double radius) const {
    const double pixels = radius * camera.width / 640.0;
    const PointPredictor predictor(camera, world_from_camera, {kMaxViewAngle, kMaxDistanceRatio});
    std::vector<PixelPrediction> predictions;
    for (int row = 0; row < descriptors_.rows; ++row) {
      const auto place = predictor.place_of(point(row));
      if (!place) continue;
      predictions.push_back(
          {row, place->pixel.cast<float>(), static_cast<float>(pixels * place->stretch), 0.0F});
    }
    return predictions;
  }

  bool depth_agrees(const Frame& frame, const SE3& camera_from_world, const Match& m) const {
    const double measured = static_cast<double>(frame.depths[static_cast<std::size_t>(m.b)]);
    const double z = (camera_from_world * point(m.a).position).z();
    return std::abs(z - measured) <= options_.depth_tolerance * z;
  }

  std::vector<PoseObservation> observations(const Frame& frame, const Camera& camera,
                                            const SE3& world_from_camera,
                                            const std::vector<Match>& matches) const {
    const SE3 camera_from_world = world_from_camera.inverse();
    std::vector<PoseObservation> observations;
    for (const Match& m : matches) {
      const auto k = static_cast<std::size_t>(m.b);
      const Eigen::Vector3d& position = point(m.a).position;
      const double z = (camera_from_world * position).z();
      observations.push_back({position, measurement_of(frame, k, camera, z)});
    }
    return observations;
  }

  void collect_inliers() {
    AreaCounts found(query_camera().view());
    AreaCounts expected = found;
    for (std::size_t i = 0; i < fit_.matches.size(); ++i) {
      if (fit_.pose.inlier[i] == 0) continue;
      const auto k = static_cast<std::size_t>(fit_.matches[i].b);
      report_.inlier_matches.push_back(
          {static_cast<std::uint32_t>(k), points_[static_cast<std::size_t>(fit_.matches[i].a)]});
      found.add(query_frame().pixels[k]);
    }
    for (const PixelPrediction& p : fit_.predictions) expected.add(p.pixel);
    report_.cells = found.occupied();
    report_.covered_share = expected.share_in(found);
    std::sort(report_.inlier_matches.begin(), report_.inlier_matches.end(),
              [](const LoopMatch& a, const LoopMatch& b) { return a.keypoint < b.keypoint; });
  }

  static double found_share(int found, int expected, const Frame& frame) {
    const int possible = std::min(expected, static_cast<int>(frame.size()));
    return possible > 0 ? static_cast<double>(found) / possible : 0.0;
  }

  // Of the matches that lie at their pixel and have a depth.
  double depth_share() const {
    const Frame& frame = query_frame();
    const SE3 camera_from_world = world_from_query_.inverse();
    int measured = 0;
    int agreeing = 0;
    for (const Match& m : fit_.matches) {
      const auto k = static_cast<std::size_t>(m.b);
      if (!frame.has_depth(k)) continue;
      const Eigen::Vector3d in_camera = camera_from_world * point(m.a).position;
      const double error2 = query_camera().squared_error(in_camera, frame.pixels[k].cast<double>());
      const double sigma = static_cast<double>(frame.sigmas[k]);
      if (error2 > options_.pose.chi2_pixel * sigma * sigma) continue;
      ++measured;
      if (depth_agrees(frame, camera_from_world, m)) ++agreeing;
    }
    return measured > 0 ? static_cast<double>(agreeing) / measured : 1.0;
  }

  // Median ratio of the distances of points that the query has, too.
  double scale() const {
    const Keyframe& query = map_.keyframe(report_.query);
    const SE3 query_from_world = query.world_from_camera.inverse();
    const SE3 query_from_candidate_world = world_from_query_.inverse();
    std::vector<double> ratios;
    for (const LoopMatch& m : report_.inlier_matches) {
      const PointId own = query.points[m.keypoint];
      if (own == kNoId) continue;
      const double here = (query_from_world * map_.point(own).position).norm();
      const double there = (query_from_candidate_world * map_.point(m.point).position).norm();
      if (here > 0.0) ratios.push_back(there / here);
    }
    if (ratios.empty()) return 1.0;
    const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
    std::nth_element(ratios.begin(), middle, ratios.end());
    return *middle;
  }

  const Map& map_;
  const DescriptorTraits& traits_;
  const LoopVerificationOptions& options_;
  LoopVerification report_;
  std::vector<PointId> points_;  // of the candidate's group, less those that the query sees
  cv::Mat descriptors_;          // one row per point
  std::vector<Match> matches_;   // by descriptor alone; a: row of the point, b: keypoint
  Fit fit_;                      // of the query
  SE3 world_from_query_;         // in the candidate's world
};

}  // namespace

const char* describe(LoopRejection rejection) {
  switch (rejection) {
    case LoopRejection::kNone:
      return "accepted";
    case LoopRejection::kGone:
      return "the candidate is no longer in the map";
    case LoopRejection::kConnected:
      return "the two share points already";
    case LoopRejection::kFewPoints:
      return "too few points around the candidate";
    case LoopRejection::kFewMatches:
      return "too few descriptors match";
    case LoopRejection::kNoPose:
      return "the matches agree on no pose";
    case LoopRejection::kFewInliers:
      return "too few points lie where the pose puts them";
    case LoopRejection::kManyOutliers:
      return "too many matches lie beside their pixel";
    case LoopRejection::kFewFound:
      return "most points that should be in view were not found";
    case LoopRejection::kNarrow:
      return "what was found fills too little of the image";
    case LoopRejection::kDepth:
      return "measured depths contradict the pose";
    case LoopRejection::kUnconfirmed:
      return "the neighbours of the query do not see the place";
  }
  return "";
}

LoopVerification verify_loop(const Map& map, KeyframeId query, KeyframeId candidate,
                             const DescriptorTraits& traits,
                             const LoopVerificationOptions& options) {
  return LoopVerifier(map, traits, options).run(query, candidate);
}

}  // namespace dxslam
