// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "core/sequence.h"
#include "io/recordings/sequence_reader.h"

namespace dxslam {

/// When the messages of a stream came.
struct StreamTiming {
  std::size_t count = 0;
  double first = 0.0, last = 0.0;  ///< seconds
  double rate = 0.0;               ///< 1/s, by the median step; 0 of fewer than two
  std::size_t gaps = 0;            ///< steps longer than 1.5 times that one
  double longest_gap = 0.0;        ///< seconds; 0 without a gap
};
/// Of stamps in any order, seconds.
StreamTiming timing_of(std::vector<double> stamps);

/// A topic of a bag, by the times at which its messages were recorded.
struct TopicInfo {
  std::string name;
  std::string type;     ///< "sensor_msgs/Image"
  std::string content;  ///< of pictures: encoding and, where it is not compressed, size
  StreamTiming timing;
};

/// How whole the images of a recording are. All files are looked for, but only some images are
/// read.
struct ImageCheck {
  std::size_t absent = 0;  ///< frames of which a file is not there
  std::string first_absent;
  std::size_t looked_at = 0;  ///< frames read, spread over those whose files are there
  std::size_t damaged = 0;    ///< of these, ones that cannot be used
  std::string first_damaged;  ///< why, one sentence
};

/// What `dxslam info` tells of a recording.
struct RecordingInfo {
  std::string format;             ///< one of sequence_formats(), or "camera"
  std::vector<TopicInfo> topics;  ///< of a bag, by name
  /// The recording or camera; none where it cannot be used, and `problem` then says why in one
  /// sentence.
  std::unique_ptr<ImageOrigin> origin;
  std::string problem;
  StreamTiming frames;                 ///< of a camera, those of three seconds
  std::size_t dropped = 0;             ///< of these, which came too fast
  std::vector<SkippedFrame> left_out;  ///< while it was opened
  ImageCheck images;
};
/// Throws InputError for what is no recording at all, a bag that cannot be read, or a camera that
/// cannot be used.
RecordingInfo inspect_recording(const std::string& path, const SequenceOptions& options);

}  // namespace dxslam
