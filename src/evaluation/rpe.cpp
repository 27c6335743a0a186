// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/rpe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"

namespace dxslam {
namespace {

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

using IndexPairs = std::vector<std::pair<std::size_t, std::size_t>>;

IndexPairs pairs_by_frames(std::size_t size, std::size_t delta, bool all_pairs) {
  IndexPairs pairs;
  for (std::size_t i = 0; i + delta < size; i += all_pairs ? 1 : delta) {
    pairs.emplace_back(i, i + delta);
  }
  return pairs;
}

double median_step(const std::vector<PosePair>& poses) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    steps.push_back(poses[i].estimate.stamp - poses[i - 1].estimate.stamp);
  }
  return summarise(steps).median;
}

IndexPairs pairs_by_seconds(const std::vector<PosePair>& poses, double delta, bool all_pairs) {
  const double tolerance = 0.5 * median_step(poses) + 1e-6;
  IndexPairs pairs;
  for (std::size_t i = 0; i + 1 < poses.size();) {
    const double wanted = poses[i].estimate.stamp + delta;
    const auto begin = poses.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    auto after = std::lower_bound(
        begin, poses.end(), wanted,
        [](const PosePair& pose, double stamp) { return pose.estimate.stamp < stamp; });
    if (after == poses.end() || (after != begin && wanted - std::prev(after)->estimate.stamp <=
                                                       after->estimate.stamp - wanted)) {
      --after;
    }
    const auto j = static_cast<std::size_t>(after - poses.begin());
    const bool near = std::abs(after->estimate.stamp - wanted) <= tolerance;
    if (near) pairs.emplace_back(i, j);
    i = near && !all_pairs ? j : i + 1;
  }
  return pairs;
}

IndexPairs select_pairs(const std::vector<PosePair>& poses, const RpeOptions& options) {
  const bool frames = options.unit == RpeOptions::Unit::kFrames;
  const bool whole = options.delta == std::floor(options.delta) && options.delta >= 1.0;
  if (!(options.delta > 0.0 && options.delta <= 1e9) || (frames && !whole)) {
    throw InputError(fmt::format(
        "delta is {:g}, expected a positive {}", options.delta,
        frames ? "whole number of frames, at most 1e9" : "number of seconds, at most 1e9"));
  }
  const IndexPairs pairs =
      frames ? pairs_by_frames(poses.size(), static_cast<std::size_t>(options.delta),
                               options.all_pairs)
             : pairs_by_seconds(poses, options.delta, options.all_pairs);
  if (!pairs.empty()) return pairs;
  throw InputError(fmt::format("no two of the {} matched poses are {:g} {} apart", poses.size(),
                               options.delta, frames ? "frames" : "seconds"));
}

}  // namespace

RpeReport evaluate_rpe(const Trajectory& truth, const Trajectory& estimate,
                       const RpeOptions& options) {
  std::vector<PosePair> poses = associate_or_throw(truth, estimate, options.max_difference);
  const Sim3 truth_from_estimate = align(poses, options.alignment);
  for (PosePair& pair : poses) {
    pair.estimate = transformed({pair.estimate}, truth_from_estimate).front();
  }
  std::vector<double> translations;
  std::vector<double> rotations;
  for (const auto& [i, j] : select_pairs(poses, options)) {
    const SE3 true_motion =
        poses[i].truth.world_from_camera.inverse() * poses[j].truth.world_from_camera;
    const SE3 motion =
        poses[i].estimate.world_from_camera.inverse() * poses[j].estimate.world_from_camera;
    const SE3 error = true_motion.inverse() * motion;
    translations.push_back(error.translation().norm());
    rotations.push_back(rotation_angle(SE3(), error) * kDegrees);
  }
  return {summarise(std::move(translations)), summarise(std::move(rotations))};
}

}  // namespace dxslam
