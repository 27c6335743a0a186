// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "core/frame.h"
#include "core/sequence.h"

namespace dxslam {

/// Writes images down as a recording that open_sequence() reads, with the calibration: the images
/// read are those written, to the bit, unless notes() says otherwise. What was added is whole on
/// the disk even if the program is killed: it is handed to the system at once. One thread at a
/// time.
class RecordingWriter {
 public:
  virtual ~RecordingWriter() = default;
  /// Adds an image, whose stamp must rise; depth may be missing. The first makes the files. Throws
  /// InputError where it cannot be written in full (full disk); the recording then ends with the
  /// image before.
  virtual void add(const RgbdImage& image) = 0;
  /// Adds what makes the recording quick to open. It can be read without.
  virtual void finish() = 0;
  /// How many images were added.
  virtual std::size_t size() const = 0;
  /// What was lost on the way, one sentence each.
  virtual const std::vector<std::string>& notes() const = 0;
};

/// A recording at `path`: an MCAP file if its name ends in .mcap (topics of sensor_msgs: colour,
/// depth registered to it, camera_info of both; times to the microsecond), or a new folder in the
/// form of TUM (PNG files, rgb.txt, depth.txt, calibration.yaml and, if known, groundtruth.txt).
/// `origin` says camera and truth. Throws InputError where there is something already: no recording
/// is ever replaced. Makes nothing yet.
std::unique_ptr<RecordingWriter> create_recording(const std::string& path,
                                                  const ImageOrigin& origin);

}  // namespace dxslam
