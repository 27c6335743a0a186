// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/camera_path.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "synthetic/random.h"

namespace dxslam {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kStepsPerNode = 40;   // of the curve's length table
constexpr double kStep = 0.02;      // metres between entries of the timetable
constexpr double kLookAhead = 0.6;  // metres
constexpr double kDegree = 3.14159265358979 / 180.0;
constexpr double kRampTime = 0.8;  // seconds to reach full speed

double wrap_angle(double angle) { return std::remainder(angle, 360.0 * kDegree); }

SE3 pose_of(const Vector3d& position, double yaw, double pitch, double roll) {
  const Vector3d forward(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw),
                         std::sin(pitch));
  const Vector3d right = forward.cross(Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d rotation;
  rotation << right, forward.cross(right), forward;
  return {Eigen::Quaterniond(rotation) * Eigen::AngleAxisd(roll, Vector3d::UnitZ()), position};
}

}  // namespace

CameraPath::CameraPath(const Layout& layout, const PathOptions& options, std::uint64_t seed)
    : nodes_(layout.path),
      options_(options),
      overlap_(layout.overlap),
      side_look_(layout.side_look) {
  require(nodes_.size() >= 4, "a path needs at least four nodes");
  speed_ = options.speed > 0.0 ? options.speed : layout.natural_speed;
  const std::uint64_t walk = mix_seed(seed, 0x9A7B);
  Random random(options.walk == 0 ? walk
                                  : mix_seed(walk, static_cast<std::uint64_t>(options.walk)));
  for (double& phase : phases_) phase = random.uniform(0.0, 6.28318);
  measure_curve();
  length_ = round_ + overlap_;
  make_timetable();
}

Vector2d CameraPath::on_curve(double parameter) const {
  const int n = static_cast<int>(nodes_.size());
  const int i = static_cast<int>(std::floor(parameter));
  const double t = parameter - i;
  const auto node = [&](int k) { return nodes_[((i + k) % n + n) % n]; };
  const double a = (1 - t) * (1 - t) * (1 - t), b = 3 * t * t * t - 6 * t * t + 4;
  const double c = -3 * t * t * t + 3 * t * t + 3 * t + 1, d = t * t * t;
  return (a * node(-1) + b * node(0) + c * node(1) + d * node(2)) / 6.0;
}

void CameraPath::measure_curve() {
  const int steps = static_cast<int>(nodes_.size()) * kStepsPerNode;
  curve_lengths_ = {0.0};
  Vector2d last = on_curve(0.0);
  for (int i = 1; i <= steps; ++i) {
    const Vector2d next = on_curve(static_cast<double>(i) / kStepsPerNode);
    curve_lengths_.push_back(curve_lengths_.back() + (next - last).norm());
    last = next;
  }
  round_ = curve_lengths_.back();
}

Vector2d CameraPath::point_at(double distance) const {
  const double within = distance - round_ * std::floor(distance / round_);
  const auto after = std::upper_bound(curve_lengths_.begin() + 1, curve_lengths_.end() - 1, within);
  const double before = *(after - 1);
  const double part = *after > before ? (within - before) / (*after - before) : 0.0;
  return on_curve((static_cast<double>(after - curve_lengths_.begin()) - 1 + part) / kStepsPerNode);
}

CameraPath::Stand CameraPath::stand_at(double distance) const {
  const double s = options_.reverse ? length_ - distance : distance;
  const Vector2d here = point_at(s);
  const Vector2d ahead = point_at(s + kLookAhead) - point_at(s - 0.3 * kLookAhead);
  const double glance = options_.glance * kDegree;
  Stand stand;
  stand.yaw =
      std::atan2(ahead.y(), ahead.x()) + side_look_ + options_.turn * kDegree +
      glance * (0.6 * std::sin(0.9 * s + phases_[0]) + 0.4 * std::sin(2.1 * s + phases_[1]));
  stand.pitch = options_.pitch * kDegree + 0.4 * glance * std::sin(1.3 * s + phases_[2]);
  const Vector2d right(std::sin(stand.yaw - side_look_), -std::cos(stand.yaw - side_look_));
  if (options_.reverse) stand.yaw += 180.0 * kDegree;
  const Vector2d shifted = here + right * options_.sideways;
  stand.position = {shifted.x(), shifted.y(), options_.height + options_.raise};
  return stand;
}

// Seconds at every kStep metres: no faster than the speed, no turn faster than the turn rate, and
// no sudden change of either.
void CameraPath::make_timetable() {
  const int steps = static_cast<int>(length_ / kStep);
  std::vector<double> slowness(steps);  // seconds a metre
  Stand last = stand_at(0.0);
  for (int i = 0; i < steps; ++i) {
    const Stand next = stand_at((i + 1) * kStep);
    const double turn = std::hypot(wrap_angle(next.yaw - last.yaw), next.pitch - last.pitch);
    slowness[i] = std::max(1.0 / speed_, turn / kStep / (0.95 * options_.turn_rate * kDegree));
    last = next;
  }
  // The slowest of the surroundings, then their mean: smooth, and never quicker than allowed.
  constexpr int kReach = 10;
  const auto first = [](int i) { return std::max(0, i - kReach); };
  const auto last_of = [steps](int i) { return std::min(steps - 1, i + kReach); };
  std::vector<double> slowest(steps);
  for (int i = 0; i < steps; ++i) {
    slowest[i] = *std::max_element(slowness.begin() + first(i), slowness.begin() + last_of(i) + 1);
  }
  times_ = {options_.standstill};
  for (int i = 0; i < steps; ++i) {
    const double sum =
        std::accumulate(slowest.begin() + first(i), slowest.begin() + last_of(i) + 1, 0.0);
    // Constant acceleration from rest: the speed grows with the root of the distance.
    const double ramp = kRampTime * speed_ / 2.0;
    const double start = std::sqrt(std::min(1.0, (i + 0.5) * kStep / ramp));
    const double mean = sum / (last_of(i) - first(i) + 1);
    times_.push_back(times_.back() + mean / start * kStep);
  }
}

double CameraPath::length_at(double time) const {
  if (time <= times_.front()) return 0.0;
  if (time >= times_.back()) return (static_cast<double>(times_.size()) - 1) * kStep;
  const auto after = std::upper_bound(times_.begin(), times_.end(), time);
  const double before = *(after - 1);
  return (static_cast<double>(after - times_.begin()) - 1 + (time - before) / (*after - before)) *
         kStep;
}

SE3 CameraPath::world_from_camera(double time) const {
  Stand stand = stand_at(length_at(time));
  // Trembling of the hand, and the steps once the walk has begun.
  const double walking = std::clamp((time - options_.standstill) / kRampTime, 0.0, 1.0);
  const double hand = options_.shake * (0.15 + 0.85 * walking);
  const auto wave = [&](int k, double hertz) {
    return std::sin(6.28318 * hertz * time + phases_[k]);
  };
  stand.position += hand * Vector3d(0.004 * wave(3, 0.9) + 0.002 * wave(4, 2.3),
                                    0.004 * wave(5, 1.1) + 0.002 * wave(6, 2.6),
                                    0.006 * wave(7, 1.7) + 0.002 * wave(8, 3.1));
  const double yaw = stand.yaw + hand * kDegree * (0.5 * wave(9, 0.8) + 0.15 * wave(10, 2.2));
  const double pitch = stand.pitch + hand * kDegree * (0.4 * wave(11, 0.95) + 0.15 * wave(12, 2.4));
  const double roll = hand * kDegree * (0.6 * wave(13, 0.7) + 0.15 * wave(14, 1.9));
  return pose_of(stand.position, yaw, pitch, roll);
}

}  // namespace dxslam
