// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "tracking/tracker.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/area_counts.h"
#include "core/error.h"
#include "core/options.h"
#include "core/rolling_shutter.h"
#include "map/view_range.h"
#include "tracking/keyframe_decision.h"
#include "tracking/recovery.h"

namespace dxslam {
namespace {

constexpr int kQuickPause = 10;
// Seconds: a mean velocity over more tells little of the moment of one image.
constexpr double kLongestReadoutInterval = 0.15;
constexpr double kLongestPrediction = 1.0;  // seconds ahead that a velocity is trusted

int count_map_points(const std::vector<KnownPoint>& known) {
  return static_cast<int>(
      std::count_if(known.begin(), known.end(), [](const KnownPoint& k) { return k.id != kNoId; }));
}

// Mapping keeps a copy of a frame of its own.
bool is_same_image(const Frame& a, const Frame& b) {
  return a.index == b.index && a.stamp == b.stamp && a.size() == b.size();
}

}  // namespace

Tracker::Tracker(const Camera& camera, const DescriptorTraits& traits,
                 const TrackerOptions& options)
    : camera_(camera),
      traits_(traits),
      options_(options),
      matching_{traits.max_distance, static_cast<float>(options.ratio),
                static_cast<float>(options.depth_tolerance)} {
  validate_options("tracking", options);
}

void Tracker::set_local_map(LocalMapPtr local_map) {
  require(local_map != nullptr, "a local map must not be null");
  if (local_ && last_.frame) follow(*local_map);
  if (!local_ || local_->reference != local_map->reference) {
    if (last_.frame && is_same_image(*last_.frame, *local_map->reference_frame)) {
      last_.points = local_map->reference_points;
    }
  }
  local_ = std::move(local_map);
}

// Mapping may have moved the keyframe that the last pose hangs on: move along.
void Tracker::follow(const LocalMap& next) {
  const SE3* before = &local_->world_from_reference;
  const SE3* after = next.find_pose(local_->reference);
  double nearest = std::numeric_limits<double>::max();
  const bool culled = after == nullptr;
  for (std::size_t i = 0; culled && i < local_->keyframes.size(); ++i) {
    const SE3& pose = local_->keyframe_poses[i];
    const double distance = translation_distance(pose, last_.world_from_camera);
    const SE3* still_there = next.find_pose(local_->keyframes[i]);
    if (still_there == nullptr || distance >= nearest) continue;
    nearest = distance;
    before = &pose;
    after = still_there;
  }
  if (after != nullptr) {
    last_.world_from_camera = *after * before->inverse() * last_.world_from_camera;
  } else if (next.component != local_->component) {
    // Where the last frame is in this world is not known; where its reference is, is.
    last_ = {next.reference_frame, next.world_from_reference, next.reference_points,
             next.reference_camera};
    last_velocity_.reset();
  }
}

TrackedFrame Tracker::track(const FramePtr& raw, std::optional<KeyframeRequest>& request) {
  request.reset();
  most_matches_ = 0;
  disbelieved_ = false;
  ++since_keyframe_.frames;
  if (!local_) return conclude(raw, start(*raw), request);
  FramePtr frame = straightened(raw, last_velocity_);
  KeypointGrid grid(frame->pixels);
  OptionalEstimate estimate = track_last_frame(*frame, grid);
  if (!estimate) return conclude(frame, estimate, request);
  // What was straightened by the last frame's velocity is now by this frame's own.
  const FramePtr straight = straightened(raw, velocity_at(*raw, estimate->world_from_camera));
  if (straight != raw) {
    frame = straight;
    grid = KeypointGrid(frame->pixels);
  }
  return conclude(frame, track_local_map(*frame, grid, *estimate), request);
}

FramePtr Tracker::straightened(const FramePtr& raw, const std::optional<Vector6d>& velocity) const {
  if (camera_.readout_time == 0.0 || !velocity) return raw;
  const double interval = raw->stamp - last_.frame->stamp;
  if (!(interval > 0.0 && interval <= kLongestReadoutInterval)) return raw;
  return without_rolling_shutter(raw, camera_, *velocity);
}

std::optional<Vector6d> Tracker::velocity_at(const Frame& frame,
                                             const SE3& world_from_camera) const {
  if (!last_.frame) return std::nullopt;
  const double interval = frame.stamp - last_.frame->stamp;
  if (!(interval > 0.0)) return std::nullopt;
  return (last_.world_from_camera.inverse() * world_from_camera).log() / interval;
}

SE3 Tracker::predict(double stamp) const {
  const double ahead = stamp - last_.frame->stamp;
  if (!last_velocity_ || !(ahead > 0.0 && ahead <= kLongestPrediction)) {
    return last_.world_from_camera;
  }
  return last_.world_from_camera * SE3::exp(ahead * *last_velocity_);
}

TrackedFrame Tracker::resume(const FramePtr& frame, LocalMapPtr local_map,
                             const SE3& world_from_camera, const std::vector<PointId>& points,
                             std::optional<KeyframeRequest>& request) {
  require(points.size() == frame->size(), "one point per keypoint is needed to resume tracking");
  const Tracker before = *this;
  restart();
  local_ = std::move(local_map);
  Estimate found;
  found.world_from_camera = world_from_camera;
  found.recovered = true;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const int index = points[i] == kNoId ? -1 : local_->find(points[i]);
    if (index < 0) continue;
    found.known.push_back(
        {static_cast<int>(i), points[i], local_->positions[static_cast<std::size_t>(index)]});
  }
  request.reset();
  const OptionalEstimate estimate = track_local_map(*frame, KeypointGrid(frame->pixels), found);
  TrackedFrame result = conclude(frame, estimate, request);
  if (!estimate) *this = before;  // what was known before may still help
  return result;
}

void Tracker::restart() {
  local_.reset();
  state_ = TrackingState::kNotStarted;
  last_ = {};
  last_velocity_.reset();
  quick_pause_ = 0;
  since_keyframe_ = {};
}

TrackedFrame Tracker::conclude(const FramePtr& frame, const OptionalEstimate& estimate,
                               std::optional<KeyframeRequest>& request) {
  if (estimate) {
    state_ = TrackingState::kTracking;
    int& best = since_keyframe_.best_tracked_points;
    best = std::max(best, estimate->map_points);
  }
  if (!estimate && local_) state_ = TrackingState::kLost;
  information_ = estimate ? estimate->information : Matrix6d::Zero();
  variance_factor_ = estimate ? estimate->variance_factor : 1.0;
  keypoints_ = static_cast<int>(frame->size());
  TrackedFrame result = report(frame, estimate);
  if (estimate && (!local_ || needs_keyframe(*frame, *estimate))) {
    request = make_request(frame, *estimate);
    result.is_keyframe = true;
  }
  remember(frame, estimate);
  return result;
}

Tracker::OptionalEstimate Tracker::start(const Frame& frame) const {
  if (frame.depth_count() < options_.min_start_points) return std::nullopt;
  return Estimate{};
}

Tracker::OptionalEstimate Tracker::track_last_frame(const Frame& frame, const KeypointGrid& grid) {
  if (state_ == TrackingState::kTracking) {
    if (OptionalEstimate estimate =
            track_by_prediction(frame, grid, predict(frame.stamp), options_.fair_agreement)) {
      return estimate;
    }
  }
  if (OptionalEstimate estimate = track_quickly(frame, grid)) return estimate;
  const int all = std::numeric_limits<int>::max();
  if (OptionalEstimate estimate = track_by_descriptors(frame, last_, all)) return estimate;
  const LastFrame reference{local_->reference_frame, local_->world_from_reference,
                            local_->reference_points, local_->reference_camera};
  if (OptionalEstimate estimate = track_by_descriptors(frame, reference, all)) return estimate;
  return track_whole_local_map(frame);
}

Tracker::OptionalEstimate Tracker::track_quickly(const Frame& frame, const KeypointGrid& grid) {
  if (quick_pause_ > 0) {
    --quick_pause_;
    return std::nullopt;
  }
  const OptionalEstimate quick = track_by_descriptors(frame, last_, options_.quick_keypoints);
  if (quick && static_cast<int>(quick->known.size()) >= options_.min_quick_inliers) {
    if (OptionalEstimate estimate =
            track_by_prediction(frame, grid, quick->world_from_camera, options_.weak_agreement)) {
      estimate->recovered = true;
      return estimate;
    }
  }
  quick_pause_ = kQuickPause;
  return std::nullopt;
}

std::vector<KnownPoint> Tracker::match_predicted(const Frame& frame, const KeypointGrid& grid,
                                                 const std::vector<KnownPoint>& last_known,
                                                 const SE3& predicted, double radius) const {
  const SE3 camera_from_world = predicted.inverse();
  std::vector<PixelPrediction> predictions;
  std::vector<std::size_t> source;
  for (std::size_t i = 0; i < last_known.size(); ++i) {
    const Eigen::Vector3d p = camera_from_world * last_known[i].position;
    const std::optional<Eigen::Vector2d> pixel = camera_.project_into_view(p);
    if (!pixel) continue;
    predictions.push_back({last_known[i].keypoint, pixel->cast<float>(),
                           scaled(radius) * static_cast<float>(camera_.stretch(*pixel)),
                           static_cast<float>(p.z())});
    source.push_back(i);
  }
  std::vector<KnownPoint> known;
  for (const Match& m :
       match_guided(predictions, last_.frame->descriptors, frame, grid, {}, matching_)) {
    KnownPoint point = last_known[source[static_cast<std::size_t>(m.a)]];
    point.keypoint = m.b;
    known.push_back(point);
  }
  return known;
}

Tracker::OptionalEstimate Tracker::track_by_prediction(const Frame& frame, const KeypointGrid& grid,
                                                       SE3 predicted, double fair) {
  const std::vector<KnownPoint> last_known = known_points(last_, *local_);
  struct Search {
    double radius;
    double enough;  // share that ends the search
  };
  for (const Search search : {Search{options_.search_radius, options_.good_agreement},
                              Search{options_.narrow_radius, fair}}) {
    const std::vector<KnownPoint> known =
        match_predicted(frame, grid, last_known, predicted, search.radius);
    note_matches(known);
    if (static_cast<int>(known.size()) < options_.min_predicted_matches) return std::nullopt;
    OptionalEstimate estimate = optimise(frame, predicted, known);
    if (!estimate) return std::nullopt;
    // A pose is judged by how many of the points in view agree with it, within a fixed radius.
    // Counting matches instead would fail: a wrong pose finds few, but these fit each other. The
    // gate of the optimiser would fail, too: in the dark, correct matches scatter beyond it.
    const SE3& pose = estimate->world_from_camera;
    const int agreeing = count_near(camera_, frame, pose, known, scaled(options_.agreement_radius));
    const int in_view = count_in_view(camera_, pose, last_known);
    if (agreeing >= search.enough * in_view) return estimate;
    if (agreeing < options_.weak_agreement * in_view) return std::nullopt;
    predicted = pose;  // a narrow search from here leaves wrong matches out and finds right ones
  }
  return std::nullopt;
}

Tracker::OptionalEstimate Tracker::track_by_descriptors(const Frame& frame, const LastFrame& source,
                                                        int keypoints) {
  const std::vector<KnownPoint> source_known = known_points(source, *local_);
  std::vector<int> known_of(source.frame->size(), -1);
  for (std::size_t i = 0; i < source_known.size(); ++i) {
    known_of[static_cast<std::size_t>(source_known[i].keypoint)] = static_cast<int>(i);
  }
  if (frame.descriptors.empty()) return std::nullopt;
  // Keypoints come by falling score.
  const cv::Mat theirs =
      source.frame->descriptors.rowRange(0, std::min(keypoints, source.frame->descriptors.rows));
  const cv::Mat ours = frame.descriptors.rowRange(0, std::min(keypoints, frame.descriptors.rows));
  std::vector<KnownPoint> known;
  for (const Match& m : match_mutual(theirs, ours, traits_.max_distance, 0.95F)) {
    const int index = known_of[static_cast<std::size_t>(m.a)];
    if (index < 0) continue;
    KnownPoint point = source_known[static_cast<std::size_t>(index)];
    point.keypoint = m.b;
    known.push_back(point);
  }
  return estimate_by_pnp(frame, std::move(known));
}

Tracker::OptionalEstimate Tracker::track_whole_local_map(const Frame& frame) {
  std::vector<KnownPoint> known;
  for (const Match& m : match_mutual(local_->descriptors, frame.descriptors, traits_.max_distance,
                                     static_cast<float>(options_.ratio))) {
    const std::size_t i = static_cast<std::size_t>(m.a);
    known.push_back({m.b, local_->ids[i], local_->positions[i]});
  }
  return estimate_by_pnp(frame, std::move(known));
}

Tracker::OptionalEstimate Tracker::estimate_by_pnp(const Frame& frame,
                                                   std::vector<KnownPoint> known) {
  note_matches(known);
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector2d> pixels;
  std::vector<float> depths;
  for (const KnownPoint& k : known) {
    const std::size_t i = static_cast<std::size_t>(k.keypoint);
    points.push_back(k.position);
    pixels.emplace_back(frame.pixels[i].cast<double>());
    depths.push_back(frame.depths[i]);
  }
  const std::optional<PnpReport> pnp = solve_pnp(camera_, points, pixels, depths, options_.pnp);
  if (!pnp) return std::nullopt;
  keep_inliers(known, pnp->inlier);
  OptionalEstimate estimate = optimise(frame, pnp->world_from_camera, std::move(known));
  if (estimate) estimate->recovered = true;
  return estimate;
}

Tracker::OptionalEstimate Tracker::optimise(const Frame& frame, const SE3& start,
                                            std::vector<KnownPoint> known) const {
  std::vector<PoseObservation> observations = pose_observations(frame, known, camera_);
  PoseReport pose = optimize_pose(camera_, start, observations, options_.pose);
  // A depth reading beside an edge is often that of another surface: where only the depth
  // disagrees, the pixel still counts.
  if (pose.success && drop_wrong_depths(camera_, pose, observations) > 0) {
    pose = optimize_pose(camera_, pose.world_from_camera, observations, options_.pose);
  }
  if (!pose.success || pose.inliers < options_.min_inliers) return std::nullopt;
  keep_inliers(known, pose.inlier);
  Estimate estimate;
  estimate.world_from_camera = pose.world_from_camera;
  estimate.known = std::move(known);
  estimate.rms_pixels = pose.rms_pixels;
  estimate.information = pose.information;
  estimate.variance_factor = pose.variance_factor;
  estimate.map_points = count_map_points(estimate.known);
  return estimate;
}

std::vector<PixelPrediction> Tracker::predict_local_points(const SE3& world_from_camera,
                                                           const std::vector<char>& known) const {
  const PointPredictor predictor(camera_, world_from_camera,
                                 {options_.max_view_angle, options_.max_distance_ratio});
  std::vector<PixelPrediction> predictions;
  for (std::size_t i = 0; i < local_->size(); ++i) {
    if (known[i] != 0) continue;
    const auto place =
        predictor.place_of(local_->positions[i], local_->normals[i], local_->distances[i]);
    if (!place) continue;
    predictions.push_back({static_cast<int>(i), place->pixel.cast<float>(),
                           scaled(options_.local_radius) * static_cast<float>(place->stretch),
                           static_cast<float>(place->depth)});
  }
  return predictions;
}

Tracker::OptionalEstimate Tracker::track_local_map(const Frame& frame, const KeypointGrid& grid,
                                                   const Estimate& estimate) {
  std::vector<char> taken(frame.size(), 0);
  std::vector<char> matched(local_->size(), 0);
  std::vector<KnownPoint> known;
  std::vector<KnownPoint> temporary;
  for (const KnownPoint& k : estimate.known) {
    const int index = k.id == kNoId ? -1 : local_->find(k.id);
    if (index < 0) {
      temporary.push_back(k);
      continue;
    }
    matched[static_cast<std::size_t>(index)] = 1;
    taken[static_cast<std::size_t>(k.keypoint)] = 1;
    known.push_back(k);
  }
  const std::vector<PixelPrediction> predictions =
      predict_local_points(estimate.world_from_camera, matched);
  for (const Match& m :
       match_guided(predictions, local_->descriptors, frame, grid, taken, matching_)) {
    const std::size_t i =
        static_cast<std::size_t>(predictions[static_cast<std::size_t>(m.a)].descriptor_row);
    known.push_back({m.b, local_->ids[i], local_->positions[i]});
    taken[static_cast<std::size_t>(m.b)] = 1;
  }
  for (const KnownPoint& k : known) ++since_keyframe_.counts[k.id].visible;
  for (const PixelPrediction& p : predictions) {
    ++since_keyframe_.counts[local_->ids[static_cast<std::size_t>(p.descriptor_row)]].visible;
  }
  if (static_cast<int>(known.size()) < options_.temporary_points_below) {
    for (const KnownPoint& k : temporary) {
      if (taken[static_cast<std::size_t>(k.keypoint)] == 0) known.push_back(k);
    }
  }
  note_matches(known);
  OptionalEstimate refined = optimise(frame, estimate.world_from_camera, std::move(known));
  if (!refined) return std::nullopt;
  refined->recovered = estimate.recovered;
  if (refined->recovered && !is_believable(frame, *refined, estimate.known, predictions)) {
    disbelieved_ = true;
    return std::nullopt;
  }
  for (const KnownPoint& k : refined->known) {
    if (k.id != kNoId) ++since_keyframe_.counts[k.id].found;
  }
  return refined;
}

bool Tracker::is_believable(const Frame& frame, const Estimate& recovered,
                            const std::vector<KnownPoint>& found,
                            const std::vector<PixelPrediction>& looked_for) const {
  if (!last_.frame) return true;  // relocalization has judged it
  const auto pixel_of = [&](const KnownPoint& known) {
    return frame.pixels[static_cast<std::size_t>(known.keypoint)];
  };
  std::vector<Eigen::Vector2f> in_view;
  std::vector<Eigen::Vector2f> agreeing;
  for (const KnownPoint& known : found) in_view.push_back(pixel_of(known));
  for (const PixelPrediction& prediction : looked_for) in_view.push_back(prediction.pixel);
  for (const KnownPoint& known : recovered.known) agreeing.push_back(pixel_of(known));
  const double share = agreeing_share(camera_.view(), frame.pixels, in_view, agreeing);
  return is_believable_recovery(
      options_.recovery, share, static_cast<int>(agreeing.size()),
      {last_.world_from_camera.inverse() * recovered.world_from_camera,
       frame.stamp - last_.frame->stamp, state_ == TrackingState::kTracking});
}

bool Tracker::needs_keyframe(const Frame& frame, const Estimate& estimate) const {
  return is_keyframe_due(
      {since_keyframe_.frames, estimate.map_points, since_keyframe_.best_tracked_points,
       local_->world_from_reference.inverse() * estimate.world_from_camera},
      frame, options_.keyframe);
}

std::vector<PointId> Tracker::points_by_keypoint(const Frame& frame,
                                                 const Estimate& estimate) const {
  std::vector<PointId> points(frame.size(), kNoId);
  for (const KnownPoint& k : estimate.known) points[static_cast<std::size_t>(k.keypoint)] = k.id;
  return points;
}

KeyframeRequest Tracker::make_request(const FramePtr& frame, const Estimate& estimate) {
  KeyframeRequest request;
  request.frame = frame;
  if (local_) {
    request.reference = local_->reference;
    request.reference_from_camera =
        local_->world_from_reference.inverse() * estimate.world_from_camera;
  }
  request.points = points_by_keypoint(*frame, estimate);
  handed_over_ = std::exchange(since_keyframe_, {});
  for (const auto& [id, count] : handed_over_.counts)
    request.counts.push_back({id, count.visible, count.found});
  std::sort(request.counts.begin(), request.counts.end(),
            [](const PointCount& a, const PointCount& b) { return a.point < b.point; });
  return request;
}

TrackedFrame Tracker::report(const FramePtr& frame, const OptionalEstimate& estimate) const {
  TrackedFrame result;
  result.index = frame->index;
  result.stamp = frame->stamp;
  result.state = state_;
  result.keypoints = static_cast<int>(frame->size());
  result.keypoints_with_depth = frame->depth_count();
  if (!estimate) return result;
  result.world_from_camera = estimate->world_from_camera;
  result.inliers = estimate->map_points;
  result.rms_pixels = estimate->rms_pixels;
  result.recovered = estimate->recovered;
  if (local_) {
    result.component = local_->component;
    result.reference = local_->reference;
    result.reference_from_camera =
        local_->world_from_reference.inverse() * estimate->world_from_camera;
  }
  return result;
}

void Tracker::remember(const FramePtr& frame, const OptionalEstimate& estimate) {
  if (!estimate) {
    last_velocity_.reset();  // no speed is known after a gap; the last good frame is kept
    return;
  }
  last_velocity_ = velocity_at(*frame, estimate->world_from_camera);
  last_ = {frame, estimate->world_from_camera, points_by_keypoint(*frame, *estimate), camera_};
}

void Tracker::note_matches(const std::vector<KnownPoint>& known) {
  most_matches_ = std::max(most_matches_, static_cast<int>(known.size()));
}

float Tracker::scaled(double pixels_at_640) const {
  return static_cast<float>(pixels_at_640 * camera_.width / 640.0);
}

}  // namespace dxslam
