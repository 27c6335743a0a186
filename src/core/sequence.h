// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/frame.h"
#include "core/trajectory.h"

namespace dxslam {

/// A frame that could not be used: which, and one sentence why.
struct SkippedFrame {
  std::size_t index = 0;
  std::string reason;
};

/// What is known of a recording before it is read. Programs show it: a wrong calibration or depth
/// factor makes every result wrong, and nothing else would tell.
struct RecordingFacts {
  std::string calibration_source;  ///< the file or preset that the camera is from
  bool has_depth = false;          ///< some frame has a depth image
  double median_depth = 0.0;       ///< metres, of the readings in the first images; 0: none there
  double depth_share = 0.0;        ///< of the pixels of the first images, those with a reading
  /// Why the true trajectory that the recording brings could not be used; empty where it could, or
  /// where there is none.
  std::string truth_problem;
  /// What was guessed, chosen or left out, one sentence each: for the user to judge.
  std::vector<std::string> notes;
};

/// What images of one camera have in common, in whichever way they are asked for.
class ImageOrigin {
 public:
  virtual ~ImageOrigin() = default;
  virtual const std::string& name() const = 0;
  virtual const Camera& camera() const = 0;
  virtual const RecordingFacts& facts() const = 0;
  /// Frames that could not be used so far.
  virtual const std::vector<SkippedFrame>& skipped() const = 0;
  /// world_from_camera of the colour camera; empty where unknown.
  virtual const Trajectory& ground_truth() const = 0;
};

/// A recording: images in time order, with calibration and, where known, the true trajectory.
/// Implementations read lazily; one thread at a time may call a sequence.
class RgbdSequence : public ImageOrigin {
 public:
  /// Number of frames listed; some may turn out to be unreadable.
  virtual std::size_t size() const = 0;
  virtual double stamp(std::size_t index) const = 0;
  /// Reads frame `index`. Nothing is returned for a broken frame; the reason is then the last
  /// entry of skipped(). Nothing without such an entry: nobody wants to wait for it any more.
  /// Throws ContractError if index >= size().
  virtual std::optional<RgbdImage> read(std::size_t index) = 0;
};

}  // namespace dxslam
