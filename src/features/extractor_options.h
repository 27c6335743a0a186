// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>

#include "core/options.h"

namespace dxslam {

/// What a user may change about any extractor. -1 (or 0 keypoints) leaves the value to the
/// extractor or its manifest.
struct ExtractorOptions {
  int max_keypoints = 0;
  int threads = 2;
  /// auto | f32 | bf16 | int8. `auto` takes the INT8 model where the manifest has one, else the
  /// float model in the fastest precision of the processor (bf16 where it has that).
  std::string precision = "auto";
  /// Forces f32 arithmetic, and the float model unless int8 is asked for: bit-equal results in
  /// every run and for every number of threads. Not read from files: it follows the system's.
  bool deterministic = false;
  /// Where compiled networks are kept: a folder, `auto` ($XDG_CACHE_HOME/dxslam or
  /// ~/.cache/dxslam), or empty for nowhere. Not used where it cannot be written.
  std::string cache_dir = "auto";
  double score_threshold = -1.0;
  int nms_radius = -1;
  int nms_iterations = -1;
  double spread = -1.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit(for_users("max_keypoints"), self.max_keypoints, {0, 20000}, "keypoints",
          "most keypoints per image; 0 = as the extractor says");
    visit(for_users("threads"), self.threads, {1, 256}, "threads", "threads of the network");
    visit(for_users("precision"), self.precision, "", "auto, f32, bf16 or int8");
    visit(for_users("cache_dir"), self.cache_dir, "",
          "folder of compiled networks; auto = the user's cache folder, empty = none");
    visit("score_threshold", self.score_threshold, {-1, 1}, "",
          "lowest score of a keypoint; -1 = as the extractor says");
    visit("nms_radius", self.nms_radius, {-1, 64}, "pixels",
          "radius of non-maximum suppression; -1 = as the extractor says");
    visit("nms_iterations", self.nms_iterations, {-1, 64}, "passes",
          "passes after the first of non-maximum suppression; -1 = as the extractor says");
    visit("spread", self.spread, {-1, 1}, "",
          "share of the keypoints given out evenly over the image; -1 = as the extractor says");
  }
};

}  // namespace dxslam
