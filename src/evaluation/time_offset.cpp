// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/time_offset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "evaluation/openloris.h"

namespace dxslam {
namespace {

constexpr std::size_t kMostPoses = 500;
constexpr std::size_t kFewestPoses = 3;
constexpr double kStep = 0.02;       // seconds between the offsets of the first pass
constexpr double kPrecision = 5e-5;  // seconds
constexpr double kEnough = 0.5;      // share of the most poses with truth at any offset

struct Fit {
  double offset = 0.0;
  double rmse = 0.0;
  std::size_t poses = 0;  // 0: could not be aligned
};

// Some of the poses, evenly.
Trajectory thinned(const Trajectory& trajectory) {
  const std::size_t step = (trajectory.size() + kMostPoses - 1) / kMostPoses;
  Trajectory some;
  for (std::size_t i = 0; i < trajectory.size(); i += step) some.push_back(trajectory[i]);
  return some;
}

class Search {
 public:
  Search(const Trajectory& truth, const Trajectory& estimate, const TimeOffsetOptions& options)
      : truth_(truth), estimate_(thinned(estimate)), options_(options) {}

  Fit at(double offset) const {
    std::vector<PosePair> pairs;
    for (const StampedPose& pose : estimate_) {
      const double stamp = pose.stamp + offset;
      const auto truth = interpolate(truth_, stamp, options_.max_truth_gap);
      if (truth) pairs.push_back({{stamp, *truth}, pose});
    }
    Fit fit{offset, 0.0, 0};
    if (pairs.size() < kFewestPoses) return fit;
    try {
      const Sim3 truth_from_estimate = align(pairs, options_.alignment);
      for (const PosePair& pair : pairs) {
        const Eigen::Vector3d moved =
            truth_from_estimate * pair.estimate.world_from_camera.translation();
        fit.rmse += (pair.truth.world_from_camera.translation() - moved).squaredNorm();
      }
    } catch (const InputError&) {  // on one line
      return fit;
    }
    fit.rmse = std::sqrt(fit.rmse / static_cast<double>(pairs.size()));
    fit.poses = pairs.size();
    return fit;
  }

  // The best of a grid over the whole range.
  Fit coarse() const {
    const auto steps = static_cast<int>(std::ceil(options_.range / kStep));
    std::vector<Fit> fits;
    std::size_t most = 0;
    for (int i = -steps; i <= steps; ++i) {
      fits.push_back(at(options_.range * i / std::max(1, steps)));
      most = std::max(most, fits.back().poses);
    }
    const Fit* best = nullptr;
    for (const Fit& fit : fits) {
      const bool enough = static_cast<double>(fit.poses) >= kEnough * static_cast<double>(most);
      if (fit.poses > 0 && enough && (best == nullptr || fit.rmse < best->rmse)) best = &fit;
    }
    return best == nullptr ? Fit{} : *best;
  }

  // Golden section around it.
  Fit refine(const Fit& start) const {
    constexpr double kGolden = 0.6180339887498949;
    double low = std::max(-options_.range, start.offset - kStep);
    double high = std::min(options_.range, start.offset + kStep);
    Fit best = start;
    Fit left = at(high - kGolden * (high - low));
    Fit right = at(low + kGolden * (high - low));
    while (high - low > kPrecision) {
      const bool go_left = left.poses > 0 && (right.poses == 0 || left.rmse < right.rmse);
      for (const Fit& fit : {left, right}) {
        if (fit.poses > 0 && fit.rmse < best.rmse) best = fit;
      }
      if (go_left) {
        high = right.offset;
        right = left;
        left = at(high - kGolden * (high - low));
      } else {
        low = left.offset;
        left = right;
        right = at(low + kGolden * (high - low));
      }
    }
    return best;
  }

 private:
  const Trajectory& truth_;
  Trajectory estimate_;
  TimeOffsetOptions options_;
};

}  // namespace

TimeOffset search_time_offset(const Trajectory& truth, const Trajectory& estimate,
                              const TimeOffsetOptions& options) {
  require(!truth.empty() && !estimate.empty(), "a search needs poses on both sides");
  const Search search(truth, estimate, options);
  const Fit coarse = search.coarse();
  if (coarse.poses == 0) {
    throw InputError(
        fmt::format("no offset of up to {:g} s between the truth ({:.13g} to {:.13g} s) and the "
                    "estimate ({:.13g} "
                    "to {:.13g} s) leaves three poses to align, expected two trajectories of the "
                    "same recording",
                    options.range, truth.front().stamp, truth.back().stamp, estimate.front().stamp,
                    estimate.back().stamp));
  }
  const Fit best = search.refine(coarse);
  return {best.offset, best.rmse, std::abs(best.offset) >= options.range - kPrecision};
}

std::optional<TimeOffset> likely_offset(const Trajectory& truth, const Trajectory& estimate,
                                        double rmse, Alignment alignment) {
  constexpr double kMuch = 0.5;        // of the error
  constexpr double kNoticed = 0.01;    // seconds
  constexpr double kAccurate = 0.01;   // metres; better than that it need not be
  constexpr std::size_t kFewest = 15;  // poses; few fit at many offsets
  if (rmse < kAccurate || truth.empty() || estimate.size() < kFewest) return std::nullopt;
  TimeOffsetOptions options;
  options.alignment = alignment;
  try {
    const TimeOffset found = search_time_offset(truth, estimate, options);
    const bool helps = found.rmse < kMuch * rmse && std::abs(found.offset) > kNoticed;
    return helps ? std::optional(found) : std::nullopt;
  } catch (const InputError&) {  // nothing to align
    return std::nullopt;
  }
}

Trajectory shifted(const Trajectory& trajectory, double seconds) {
  Trajectory moved = trajectory;
  for (StampedPose& pose : moved) pose.stamp += seconds;
  return moved;
}

}  // namespace dxslam
