// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/association.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "geometry/alignment.h"

namespace dxslam {
namespace {

void check(const Trajectory& trajectory) {
  const bool rising =
      std::is_sorted(trajectory.begin(), trajectory.end(),
                     [](const StampedPose& a, const StampedPose& b) { return a.stamp < b.stamp; });
  require(rising, "a trajectory to evaluate must be by rising stamp");
}

// The pose of `trajectory`, which is not empty, nearest to `stamp`.
const StampedPose& nearest(const Trajectory& trajectory, double stamp) {
  const auto after =
      std::upper_bound(trajectory.begin(), trajectory.end(), stamp,
                       [](double value, const StampedPose& pose) { return value < pose.stamp; });
  if (after == trajectory.begin()) return *after;
  const auto before = std::prev(after);
  if (after == trajectory.end() || stamp - before->stamp <= after->stamp - stamp) return *before;
  return *after;
}

}  // namespace

std::vector<PosePair> associate(const Trajectory& truth, const Trajectory& estimate,
                                double max_difference) {
  check(truth);
  check(estimate);
  if (truth.empty() || estimate.empty()) return {};
  const bool estimate_is_longer = estimate.size() > truth.size();
  const Trajectory& shorter = estimate_is_longer ? truth : estimate;
  const Trajectory& longer = estimate_is_longer ? estimate : truth;
  std::vector<PosePair> pairs;
  for (const StampedPose& pose : shorter) {
    const StampedPose& other = nearest(longer, pose.stamp);
    if (std::abs(other.stamp - pose.stamp) > max_difference) continue;
    pairs.push_back(estimate_is_longer ? PosePair{pose, other} : PosePair{other, pose});
  }
  return pairs;
}

std::vector<PosePair> associate_or_throw(const Trajectory& truth, const Trajectory& estimate,
                                         double max_difference) {
  for (const auto& [trajectory, name] : {std::pair{&truth, "truth"}, {&estimate, "estimate"}}) {
    if (trajectory->empty()) throw InputError(fmt::format("the {} holds no pose", name));
  }
  std::vector<PosePair> pairs = associate(truth, estimate, max_difference);
  if (!pairs.empty()) return pairs;
  throw InputError(fmt::format(
      "no stamps of the truth ({:.13g} to {:.13g} s) and the estimate ({:.13g} to {:.13g} "
      "s) are within "
      "{} s, expected two trajectories of the same recording",
      truth.front().stamp, truth.back().stamp, estimate.front().stamp, estimate.back().stamp,
      max_difference));
}

Sim3 align(const std::vector<PosePair>& pairs, Alignment alignment) {
  if (alignment == Alignment::kNone) return {};
  std::vector<Eigen::Vector3d> source;
  std::vector<Eigen::Vector3d> target;
  for (const PosePair& pair : pairs) {
    source.push_back(pair.estimate.world_from_camera.translation());
    target.push_back(pair.truth.world_from_camera.translation());
  }
  const auto fit = align_points(source, target, alignment == Alignment::kSim3);
  if (fit) return *fit;
  throw InputError(fmt::format(
      "the {} matched poses cannot be aligned, expected at least three that are not in one line",
      pairs.size()));
}

Trajectory transformed(const Trajectory& estimate, const Sim3& truth_from_estimate) {
  Trajectory moved;
  moved.reserve(estimate.size());
  for (const StampedPose& pose : estimate) {
    moved.push_back({pose.stamp,
                     {truth_from_estimate.rotation() * pose.world_from_camera.rotation(),
                      truth_from_estimate * pose.world_from_camera.translation()}});
  }
  return moved;
}

}  // namespace dxslam
