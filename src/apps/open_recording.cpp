// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/open_recording.h"

#include "apps/console.h"

namespace dxslam::apps {

std::unique_ptr<RgbdSequence> open_recording(const std::string& path,
                                             const SequenceOptions& options) {
  std::unique_ptr<RgbdSequence> recording = open_sequence(path, options);
  for (const std::string& note : recording->facts().notes) warn("{}: {}", path, note);
  return recording;
}

}  // namespace dxslam::apps
