// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <random>
#include <unordered_map>
#include <vector>

#include "core/features.h"
#include "core/random_unit.h"
#include "core/test_camera.h"
#include "geometry/alignment.h"
#include "map/map.h"
#include "map/test_frame.h"

namespace dxslam {

/// A ring-shaped corridor whose outer wall is full of described points: a test scene for loops,
/// which needs no images. The camera walks round the inner side and looks at the wall. Everything
/// follows from the seed.
class RingScene {
 public:
  /// 35 m are 220 m round.
  explicit RingScene(double radius = 35.0, double points_per_metre = 30.0, unsigned seed = 7)
      : radius_(radius), generator_(seed) {
    const int n = static_cast<int>(circumference() * points_per_metre);
    std::uniform_real_distribution<double> angle(0.0, 2.0 * std::numbers::pi);
    std::uniform_real_distribution<double> depth(2.5, 4.5), height(-1.5, 1.5);
    for (int i = 0; i < n; ++i) angles_.push_back(angle(generator_));
    std::sort(angles_.begin(), angles_.end());
    descriptors_.create(n, kDimension, CV_32F);
    for (int i = 0; i < n; ++i) {
      points_.push_back(
          at(angles_[static_cast<std::size_t>(i)], depth(generator_), height(generator_)));
      cv::Mat(random_unit(generator_, kDimension)).reshape(1, 1).copyTo(descriptors_.row(i));
    }
  }

  const Camera& camera() const { return camera_; }
  DescriptorTraits traits() const { return {false, descriptors_.cols, 0.6F, 0}; }
  double circumference() const { return 2.0 * std::numbers::pi * radius_; }

  /// world_from_camera after `metres` along the ring. The world is the camera at 0.
  SE3 pose(double metres) const { return on_ring(0.0).inverse() * on_ring(metres); }

  /// Makes the wall from `to` on, `length` metres long, look like that from `from` on; of its
  /// points only those between the two heights, the rest stays as it was.
  void copy_wall(double from, double to, double length, double lowest = -2.0,
                 double highest = 2.0) {
    const SE3 to_from_from = on_ring(to) * on_ring(from).inverse();
    const auto inside = [&](std::size_t i, double start) {
      return angles_[i] >= start / radius_ && angles_[i] < (start + length) / radius_ &&
             points_[i].y() >= lowest && points_[i].y() <= highest;
    };
    std::vector<std::size_t> sources;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (inside(i, from)) sources.push_back(i);
      if (inside(i, to)) places.push_back(i);
    }
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (k < sources.size()) {
        points_[places[k]] = to_from_from * points_[sources[k]];
        descriptors_.row(static_cast<int>(sources[k]))
            .copyTo(descriptors_.row(static_cast<int>(places[k])));
      } else {
        points_[places[k]].y() += 100.0;  // out of sight: the copy has fewer
      }
    }
  }

  /// Keypoints of all points in view, with pixel noise and depth; `sources` receives the point
  /// behind each keypoint.
  FramePtr frame(std::int64_t index, double metres, std::vector<int>& sources, double noise = 0.3) {
    auto frame = empty_test_frame(index);
    sources.clear();
    std::normal_distribution<double> normal(0.0, noise);
    const SE3 camera_from_ring = on_ring(metres).inverse();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double apart = std::remainder(angles_[i] - metres / radius_, 2.0 * std::numbers::pi);
      if (std::abs(apart) * radius_ > 4.0) continue;
      const auto offset = [&] { return Eigen::Vector2d(normal(generator_), normal(generator_)); };
      if (add_test_keypoint(camera_, camera_from_ring * points_[i], offset,
                            descriptors_.row(static_cast<int>(i)), *frame)) {
        sources.push_back(static_cast<int>(i));
      }
    }
    return frame;
  }

 private:
  static constexpr int kDimension = 32;

  /// Point of the ring's frame: `depth` metres outside the path, `height` below it.
  Eigen::Vector3d at(double angle, double depth, double height) const {
    const double r = radius_ + depth;
    return {r * std::sin(angle), height, -r * std::cos(angle)};
  }
  SE3 on_ring(double metres) const {
    const double a = metres / radius_;
    Eigen::Matrix3d rotation;  // columns: right, down, outwards
    rotation << -std::cos(a), 0.0, std::sin(a), 0.0, 1.0, 0.0, -std::sin(a), 0.0, -std::cos(a);
    return {rotation, at(a, 0.0, 0.0)};
  }

  double radius_;
  std::mt19937 generator_;
  Camera camera_ = test_camera();
  std::vector<double> angles_;           // of the points, rising
  std::vector<Eigen::Vector3d> points_;  // in the ring's frame
  cv::Mat descriptors_;
};

/// What odometry gets wrong from one keyframe to the next.
struct Drift {
  double turn_bias = 0.0003;   ///< radians
  double turn_noise = 0.0003;  ///< radians, about each axis
  double move_bias = 0.002;    ///< metres along the path
  double move_noise = 0.001;   ///< metres, in each direction
  double scale_bias = 0.0;     ///< log of scale; as of a camera without depth
};

/// A walk round a RingScene by drifting odometry: each keyframe is bound to the points of the
/// keyframes just before it and makes new ones, so that a place seen again is in the map twice.
class RingWalk {
 public:
  explicit RingWalk(RingScene& scene, const Drift& drift = {}, unsigned seed = 11)
      : scene_(scene), drift_(drift), generator_(seed) {}

  /// A keyframe after `metres` along the ring, seen from the one before as odometry would have it;
  /// with `begin` it begins a component with a world of its own.
  KeyframeId add(double metres, bool begin = false) {
    begin = begin || truth_.empty();
    if (begin) {
      estimate_ = SE3();
      known_.clear();
    } else {
      const SE3 moved = scene_.pose(metres_).inverse() * scene_.pose(metres);
      scale_ *= std::exp(drift_.scale_bias);
      estimate_ = map.keyframe(last_).world_from_camera *
                  SE3(moved.rotation(), scale_ * moved.translation()) * SE3::exp(error());
    }
    metres_ = metres;
    std::vector<int> sources;
    FramePtr frame = scene_.frame(static_cast<std::int64_t>(truth_.size()), metres, sources);
    map.add_camera(scene_.camera());
    last_ = map.add_keyframe(frame, estimate_, begin ? kNoId : last_);
    truth_.push_back(scene_.pose(metres));
    for (std::size_t i = 0; i < sources.size(); ++i)
      bind(sources[i], static_cast<std::uint32_t>(i));
    return last_;
  }

  /// Keyframes from `from` to `to` metres, `step` apart. Returns the last one.
  KeyframeId walk(double from, double to, double step = 0.5) {
    const int n = static_cast<int>(std::lround((to - from) / step));
    for (int i = 0; i <= n; ++i) add(from + i * step);
    return last_;
  }

  /// Root mean square distance from the truth of the keyframes of a component, after alignment.
  double ate(std::uint32_t component = 0, bool with_scale = false) const {
    std::vector<Eigen::Vector3d> estimates;
    std::vector<Eigen::Vector3d> truths;
    for (const KeyframeId id : map.keyframe_ids()) {
      if (map.keyframe(id).component != component) continue;
      estimates.push_back(map.keyframe(id).world_from_camera.translation());
      truths.push_back(truth_[id].translation());
    }
    const Sim3 aligned = align_points(estimates, truths, with_scale).value();
    double sum = 0.0;
    for (std::size_t i = 0; i < truths.size(); ++i) {
      sum += (aligned * estimates[i] - truths[i]).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(truths.size()));
  }

  const SE3& truth(KeyframeId id) const { return truth_[id]; }

  Map map;

 private:
  struct Known {
    PointId point;
    KeyframeId last_seen;
  };

  Vector6d error() {
    std::normal_distribution<double> normal;
    Vector6d e;
    for (int i = 0; i < 3; ++i) e(i) = drift_.move_noise * normal(generator_);
    for (int i = 3; i < 6; ++i) e(i) = drift_.turn_noise * normal(generator_);
    e(0) += drift_.move_bias;
    e(4) += drift_.turn_bias;
    return e;
  }

  void bind(int source, std::uint32_t keypoint) {
    const auto it = known_.find(source);
    if (it != known_.end() && last_ - it->second.last_seen <= 3 &&
        map.has_point(it->second.point)) {
      it->second.last_seen = last_;
      map.add_observation(it->second.point, last_, keypoint);
      map.refresh_point(it->second.point);
      return;
    }
    const Frame& frame = *map.keyframe(last_).frame;
    const Eigen::Vector3d in_camera =
        scene_.camera().unproject(frame.pixels[keypoint].cast<double>(),
                                  scale_ * static_cast<double>(frame.depths[keypoint]));
    known_[source] = {map.add_point(estimate_ * in_camera, last_, keypoint), last_};
  }

  RingScene& scene_;
  Drift drift_;
  std::mt19937 generator_;
  std::vector<SE3> truth_;  // by keyframe
  std::unordered_map<int, Known> known_;
  SE3 estimate_;
  double scale_ = 1.0;
  double metres_ = 0.0;
  KeyframeId last_ = kNoId;
};

/// All that a map says, for telling whether it changed.
struct MapState {
  std::vector<KeyframeId> keyframes;
  std::vector<SE3> poses;
  std::vector<std::vector<PointId>> bound;
  std::vector<PointId> points;
  std::vector<Eigen::Vector3d> positions;

  explicit MapState(const Map& map) : keyframes(map.keyframe_ids()), points(map.point_ids()) {
    for (const KeyframeId id : keyframes) {
      poses.push_back(map.keyframe(id).world_from_camera);
      bound.push_back(map.keyframe(id).points);
    }
    for (const PointId id : points) positions.push_back(map.point(id).position);
  }
  bool operator==(const MapState& other) const {
    const auto same_pose = [](const SE3& a, const SE3& b) {
      return a.translation() == b.translation() && a.rotation().coeffs() == b.rotation().coeffs();
    };
    return keyframes == other.keyframes && points == other.points && bound == other.bound &&
           positions == other.positions &&
           std::equal(poses.begin(), poses.end(), other.poses.begin(), other.poses.end(),
                      same_pose);
  }
};

}  // namespace dxslam
