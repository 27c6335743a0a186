// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <functional>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "core/sequence.h"
#include "io/primitives/image_file.h"

namespace dxslam {

/// The files of one frame, or what messages call its images. `depth` is empty for a recording
/// without depth.
struct ListedFrame {
  double stamp = 0.0;
  std::string color;
  std::string depth;
};

/// An image of frame `index`, which is `frame`, as read_color_image() or read_depth_image() return
/// it. Throws InputError, also for another size.
using ImageLoader =
    std::function<cv::Mat(std::size_t index, const ListedFrame& frame, const ExpectedSize& size)>;

/// What a format reader finds out about a recording; what all formats then have in common is done
/// by the sequence made from it.
struct SequenceListing {
  std::string name;
  Camera camera;
  std::string calibration_source;  ///< file or preset, for messages
  std::vector<ListedFrame> frames;
  std::vector<SkippedFrame> skipped;  ///< left out already
  Trajectory ground_truth;
  std::string truth_problem;       ///< see RecordingFacts
  std::vector<std::string> notes;  ///< see RecordingFacts
  /// Raw CV_16UC1 depth to raw CV_16UC1 depth registered to colour; none = is registered.
  std::function<cv::Mat(const cv::Mat&)> register_depth;
  cv::Size raw_depth_size;             ///< of images before that; empty: the colour camera's
  ImageLoader load_color, load_depth;  ///< none: images are files
};

/// Which of `count` images to look at, in order, until some are found good: the first ten, then up
/// to a hundred spread over all others, as the first ten may be missing.
std::vector<std::size_t> probe_order(std::size_t count);

/// Checks the listing and decodes up to three frames, of the first ten unless all of these are
/// bad (probe_order). Throws InputError if none is usable, their median depth is not that of a
/// scene (0.05 to 30 m), or a rolling shutter would take longer than from image to image.
std::unique_ptr<RgbdSequence> make_sequence(SequenceListing listing);

}  // namespace dxslam
