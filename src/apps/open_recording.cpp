// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/open_recording.h"

#include "apps/console.h"
#include "apps/usage.h"

namespace dxslam::apps {

std::unique_ptr<RgbdSequence> open_recording(const std::string& path,
                                             const SequenceOptions& options) {
  std::unique_ptr<RgbdSequence> recording = open_sequence(path, options);
  for (const std::string& note : recording->facts().notes) {
    warn("{}{}", note.starts_with(path) ? "" : path + ": ", note);
  }
  return recording;
}

std::string recording_help() { return "Recording: " + known_recordings(); }

void add_reader_options(CLI::App& command, SequenceOptions& options) {
  command.add_option("--format", options.format, sequence_format_list())
      ->check(recording_format())
      ->capture_default_str();
  command.add_option("--calibration", options.calibration,
                     "Camera preset or YAML file (default: by format)");
  command.add_option("--color-topic", options.color_topic,
                     "Topic of the colour images in a bag (default: the likeliest)");
  command.add_option("--depth-topic", options.depth_topic,
                     "Topic of the depth images in a bag (default: the likeliest)");
}

}  // namespace dxslam::apps
