// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <optional>
#include <unordered_map>
#include <vector>

#include "core/camera.h"
#include "core/features.h"
#include "map/local_map.h"
#include "matching/guided_matching.h"
#include "tracking/frame_matches.h"
#include "tracking/tracker_options.h"
#include "tracking/tracking_types.h"

namespace dxslam {

/// Finds the pose of every frame against the local map (paper III.A, "Tracking"): predict, match
/// against the last frame, optimise, match against the local map, optimise, decide on a keyframe.
/// Belongs to one thread. Knows the map only through snapshots.
class Tracker {
 public:
  Tracker(const Camera& camera, const DescriptorTraits& traits, const TrackerOptions& options);

  /// The newest snapshot; poses follow the keyframe they hang on, or the nearest that is still
  /// there.
  void set_local_map(LocalMapPtr local_map);
  bool has_local_map() const { return local_ != nullptr; }

  /// Tracks one frame; frames come in time order. `request` is filled when it should become a
  /// keyframe (the first usable frame always does).
  TrackedFrame track(const FramePtr& frame, std::optional<KeyframeRequest>& request);
  /// Goes on from a pose found by other means (relocalization): `frame` is at `world_from_camera`
  /// in the world of `local_map` and sees `points`, one per keypoint. Lost still, if the local map
  /// does not bear it out.
  TrackedFrame resume(const FramePtr& frame, LocalMapPtr local_map, const SE3& world_from_camera,
                      const std::vector<PointId>& points, std::optional<KeyframeRequest>& request);
  /// The request of the frame tracked last was not served: what spoke for it counts on.
  void take_back_request() { since_keyframe_ = std::move(handed_over_); }
  /// Of the pose of the frame given last, as in pose_covariance(); nothing where it has none, or
  /// began a map.
  std::optional<Matrix6d> covariance() const;
  /// Why the frame given last has no pose.
  LossReason loss_reason() const;
  /// Known points found in the frame given last, by the attempt that found most.
  int most_matches() const { return most_matches_; }
  /// Forgets the local map and all motion: the next usable frame starts a new one.
  void restart();

 private:
  struct Estimate {
    SE3 world_from_camera;
    std::vector<KnownPoint> known;  // inliers only
    double rms_pixels = 0.0;
    Matrix6d information = Matrix6d::Zero();  // with the factor, as in PoseReport
    double variance_factor = 1.0;
    bool recovered = false;
    int map_points = 0;
  };
  using OptionalEstimate = std::optional<Estimate>;

  /// What is gathered from one request for a keyframe to the next.
  struct SinceKeyframe {
    std::unordered_map<PointId, PointCount> counts;
    int frames = 0;
    int best_tracked_points = 0;
  };

  void follow(const LocalMap& next);
  OptionalEstimate start(const Frame& frame) const;
  /// The frame without the camera's rolling shutter, as far as `velocity` is known.
  FramePtr straightened(const FramePtr& raw, const std::optional<Vector6d>& velocity) const;
  /// Mean motion per second since the last frame with a pose.
  std::optional<Vector6d> velocity_at(const Frame& frame, const SE3& world_from_camera) const;
  /// Where constant velocity takes the camera by `stamp`, however many frames lie between. Where
  /// the last frame was, if the clock did not go on.
  SE3 predict(double stamp) const;
  OptionalEstimate track_last_frame(const Frame& frame, const KeypointGrid& grid);
  /// Matches the descriptors of the strongest keypoints, finds the pose from them, and then
  /// searches for all other points around their predicted pixels. After a failure it is left out
  /// for some frames, since the light that made it fail lasts.
  OptionalEstimate track_quickly(const Frame& frame, const KeypointGrid& grid);
  /// Matches the last frame's points around the pixels at which a pose puts them. `fair`: the share
  /// of those in view that must agree after the second search.
  OptionalEstimate track_by_prediction(const Frame& frame, const KeypointGrid& grid, SE3 predicted,
                                       double fair);
  std::vector<KnownPoint> match_predicted(const Frame& frame, const KeypointGrid& grid,
                                          const std::vector<KnownPoint>& last_known,
                                          const SE3& predicted, double radius) const;
  /// Matches the strongest `keypoints` of either frame.
  OptionalEstimate track_by_descriptors(const Frame& frame, const LastFrame& source, int keypoints);
  OptionalEstimate track_whole_local_map(const Frame& frame);
  OptionalEstimate estimate_by_pnp(const Frame& frame, std::vector<KnownPoint> known);
  OptionalEstimate track_local_map(const Frame& frame, const KeypointGrid& grid,
                                   const Estimate& estimate);
  std::vector<PixelPrediction> predict_local_points(const SE3& world_from_camera,
                                                    const std::vector<char>& known) const;
  OptionalEstimate optimise(const Frame& frame, const SE3& start,
                            std::vector<KnownPoint> known) const;
  /// Whether a pose found by descriptors alone is that of this place: `found` by them, and
  /// `looked_for` around it.
  bool is_believable(const Frame& frame, const Estimate& recovered,
                     const std::vector<KnownPoint>& found,
                     const std::vector<PixelPrediction>& looked_for) const;
  bool needs_keyframe(const Frame& frame, const Estimate& estimate) const;
  TrackedFrame conclude(const FramePtr& frame, const OptionalEstimate& estimate,
                        std::optional<KeyframeRequest>& request);
  TrackedFrame report(const FramePtr& frame, const OptionalEstimate& estimate) const;
  void remember(const FramePtr& frame, const OptionalEstimate& estimate);
  /// For most_matches().
  void note_matches(const std::vector<KnownPoint>& known);
  KeyframeRequest make_request(const FramePtr& frame, const Estimate& estimate);
  std::vector<PointId> points_by_keypoint(const Frame& frame, const Estimate& estimate) const;
  float scaled(double pixels_at_640) const;

  Camera camera_;
  DescriptorTraits traits_;
  TrackerOptions options_;
  GuidedMatchingOptions matching_;
  LocalMapPtr local_;
  TrackingState state_ = TrackingState::kNotStarted;
  LastFrame last_;
  std::optional<Vector6d> last_velocity_;  // per second, in the last camera's frame
  int quick_pause_ = 0;                    // frames for which track_quickly is not tried
  SinceKeyframe since_keyframe_;
  SinceKeyframe handed_over_;  // as it was before the last request

  // Of the frame given last, for those who ask how it went.
  Matrix6d information_ = Matrix6d::Zero();
  double variance_factor_ = 1.0;
  int keypoints_ = 0;
  int most_matches_ = 0;
  bool disbelieved_ = false;  // a pose was found
};

}  // namespace dxslam
