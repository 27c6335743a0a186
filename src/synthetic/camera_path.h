// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <vector>

#include "core/se3.h"
#include "synthetic/layout.h"

namespace dxslam {

struct PathOptions {
  double speed = 0.0;       // metres per second; 0: the scene's own
  double turn_rate = 40.0;  // degrees per second
  double height = 1.35;     // metres
  double pitch = -8.0;      // degrees
  double glance = 14.0;     // degrees
  double shake = 1.0;
  double standstill = 0.5;  // seconds
  double sideways = 0.0;    // metres
  double raise = 0.0;       // metres
  double turn = 0.0;        // degrees
  bool reverse = false;
  int walk = 0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("speed", self.speed, {0.0, 10.0}, "m/s", "walking speed; 0: the scene's own");
    visit("turn_rate", self.turn_rate, {1.0, 360.0}, "deg/s",
          "fastest turn; the walk slows down for it");
    visit("height", self.height, {0.1, 2.3}, "m", "of the camera above the floor");
    visit("pitch", self.pitch, {-60.0, 60.0}, "deg", "mean look up (+) or down (-)");
    visit("glance", self.glance, {0.0, 60.0}, "deg", "how far the look wanders sideways");
    visit("shake", self.shake, {0.0, 10.0}, "", "strength of the hand's trembling and the steps");
    visit("standstill", self.standstill, {0.0, 60.0}, "s", "time at rest before the walk");
    visit("sideways", self.sideways, {-0.4, 0.4}, "m",
          "the whole path shifted to the walker's right");
    visit("raise", self.raise, {-1.0, 1.0}, "m", "the whole path shifted up");
    visit("turn", self.turn, {-180.0, 180.0}, "deg", "the look turned to the left");
    visit("walk", self.walk, {0, 2147483647}, "",
          "which of many walks along the path, with other glances and another hand");
    visit("reverse", self.reverse, "", "walk the path the other way, looking the other way");
  }
};

/// The way of a camera through a scene: a smooth closed curve (uniform cubic B-spline) walked once
/// and a little more, looking along it with slow glances. Immutable, thread-safe.
class CameraPath {
 public:
  /// `seed` and the walk decide glances and trembling.
  CameraPath(const Layout& layout, const PathOptions& options, std::uint64_t seed);

  /// Pose at `time` seconds; before 0 and after duration() the camera is at rest.
  SE3 world_from_camera(double time) const;
  double duration() const { return times_.back(); }
  /// Metres from the start, without trembling.
  double length_at(double time) const;
  double length() const { return length_; }

 private:
  struct Stand {
    Eigen::Vector3d position;
    double yaw, pitch;  // radians
  };
  Eigen::Vector2d on_curve(double parameter) const;
  Eigen::Vector2d point_at(double distance) const;
  Stand stand_at(double distance) const;
  void measure_curve();
  void make_timetable();

  std::vector<Eigen::Vector2d> nodes_;
  PathOptions options_;
  double overlap_ = 0.0, side_look_ = 0.0, speed_ = 0.5;
  double phases_[16] = {};
  std::vector<double> curve_lengths_;  // at equal steps of the curve's parameter, one round
  double round_ = 0.0;                 // metres of one round
  double length_ = 0.0;                // metres walked
  std::vector<double> times_;          // seconds at equal steps of distance
};

}  // namespace dxslam
