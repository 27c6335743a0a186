// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/trajectory_pair.h"

#include <fmt/format.h>

#include <utility>

#include "core/error.h"
#include "io/formats/trajectory_reader.h"
#include "io/recordings/sequence_reader.h"

namespace dxslam::apps {
namespace {

void copy_stamps(const Trajectory& from, Trajectory& to) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i].stamp = from[i].stamp;
}

}  // namespace

TrajectoryPair load_trajectory_pair(const TrajectoryFiles& files) {
  TrajectoryFile truth = load_ground_truth(files.truth, files.truth_format);
  TrajectoryFile estimate = read_trajectory_file(files.estimate, files.format);
  TrajectoryPair pair;
  pair.truth = std::move(truth.poses);
  pair.estimate = std::move(estimate.poses);
  pair.has_stamps = truth.has_stamps() || estimate.has_stamps();
  pair.by_index = !truth.has_stamps() || !estimate.has_stamps();
  for (const std::string& hint : truth.hints) pair.notes.push_back(files.truth + ": " + hint);
  for (const std::string& hint : estimate.hints) pair.notes.push_back(files.estimate + ": " + hint);
  if (!pair.by_index) return pair;
  if (pair.truth.size() != pair.estimate.size()) {
    throw InputError(
        fmt::format("{}: {} poses without stamps (KITTI) and {} poses of {}, expected one for each",
                    truth.has_stamps() ? files.estimate : files.truth,
                    truth.has_stamps() ? pair.estimate.size() : pair.truth.size(),
                    truth.has_stamps() ? pair.truth.size() : pair.estimate.size(),
                    truth.has_stamps() ? files.truth : files.estimate));
  }
  if (truth.has_stamps()) copy_stamps(pair.truth, pair.estimate);
  if (estimate.has_stamps()) copy_stamps(pair.estimate, pair.truth);
  return pair;
}

}  // namespace dxslam::apps
