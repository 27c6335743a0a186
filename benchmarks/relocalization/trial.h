// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "aligned_truth.h"
#include "core/sequence.h"
#include "features/extractor.h"
#include "relocalization/relocalizer.h"
#include "slam/system.h"

namespace dxslam::benchmark {

/// A map made by the whole system from some frames of a recording, and where it lies in the frame
/// of the truth.
class MapUnderTest {
 public:
  using Picker = std::function<bool(std::size_t position, const RgbdSequence&)>;

  /// Runs the system, in deterministic order, over the frames that `in_map` picks.
  /// `right_distance` is the unit of align_poses().
  /// Throws InputError if fewer than three frames were tracked.
  MapUnderTest(RgbdSequence& sequence, std::unique_ptr<FeatureExtractor> extractor,
               const Picker& in_map, double right_distance);

  const Map& map() const { return system_->map(); }
  const GlobalIndex& index() const { return index_; }
  const Camera& camera() const { return sequence_.camera(); }
  FeatureExtractor& extractor() { return *extractor_; }
  /// Fitted to all tracked frames of the map.
  const MapAlignment& alignment() const { return alignment_; }
  const MapAlignment& alignment_with_offset() const { return alignment_with_offset_; }
  /// How far these frames themselves are from the truth by either alignment.
  std::vector<Deviation> own_deviations(const MapAlignment& alignment) const;
  /// True poses of the frames that went into the map.
  const Trajectory& true_map_poses() const { return true_map_poses_; }
  /// The true pose of the frame of the map that was taken at `stamp`.
  SE3 true_pose(double stamp) const;

 private:
  RgbdSequence& sequence_;
  std::unique_ptr<FeatureExtractor> extractor_;
  std::unique_ptr<System> system_;
  GlobalIndex index_;
  std::vector<PosePair> pairs_;
  MapAlignment alignment_;
  MapAlignment alignment_with_offset_;
  Trajectory true_map_poses_;
};

/// An image to be located. Without a true pose it is of another place, and no pose is right.
struct Query {
  RgbdImage image;
  std::optional<SE3> truth_from_camera;  ///< of the camera as it was before it was turned
  SE3 turned_from_camera;                ///< how far the image was turned afterwards
};

/// What became of one query.
struct Outcome {
  RelocalizationReport report;
  bool elsewhere = false;
  Deviation global;       ///< from the truth, by align_poses
  Deviation with_offset;  ///< by align_with_camera_offset
  Deviation local;        ///< pose and truth both relative to the reference keyframe
  double stamp = 0.0;     ///< of the image, seconds
  double ms = 0.0;        ///< processor time, without the features
};

Outcome locate(MapUnderTest& map, const Relocalizer& relocalizer, const Query& query);
/// The same in `searched`, a map that contains the keyframes of `map` under ids of its own.
Outcome locate(MapUnderTest& map, const Map& searched, const GlobalIndex& index,
               const Relocalizer& relocalizer, const Query& query);

/// One line of the results: many queries of one kind.
struct Row {
  std::string name;
  double right_distance = 0.05;  ///< metres
  double right_angle = 5.0;      ///< degrees
  std::vector<Outcome> outcomes;
};

/// What taking weak poses that agree over consecutive images (RelocalizationConsensus) would add.
struct Agreement {
  int accepted = 0;  ///< images that are not accepted by themselves
  int wrong = 0;     ///< of these
};
Agreement agreement(const Row& row);

/// Writes the heading, and a row, of a table in Markdown to stdout.
void print_heading();
void print_row(const Row& row);
/// Appends every outcome as CSV; the heading with it if the file is new.
void append_csv(const std::string& path, const Row& row);

}  // namespace dxslam::benchmark
