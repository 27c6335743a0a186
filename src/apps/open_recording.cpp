// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/open_recording.h"

#include <fmt/format.h>

#include "apps/console.h"
#include "apps/stoppable_sequence.h"
#include "apps/usage.h"
#include "core/error.h"
#include "io/sources/open_source.h"

namespace dxslam::apps {

std::unique_ptr<RgbdSequence> open_recording(const std::string& path,
                                             const SequenceOptions& options) {
  if (is_live_source(path)) {
    throw InputError(path +
                     ": a camera, expected a recording; `dxslam record` makes one of a camera");
  }
  std::unique_ptr<RgbdSequence> recording = open_sequence(path, options);
  for (const std::string& note : recording->facts().notes) {
    warn("{}{}", note.starts_with(path) ? "" : path + ": ", note);
  }
  return recording;
}

std::unique_ptr<ImageSource> open_images(const std::string& source, const SequenceOptions& options,
                                         const ImageSelection& selection) {
  if (is_live_source(source)) return open_live_source(source, options, selection);
  return make_image_source(stoppable(open_recording(source, options)), selection);
}

std::string source_help() {
  return fmt::format("{}; or a camera: {}", recording_help(), known_live_sources());
}

std::string recording_help() { return "recording: " + known_recordings(); }

void add_reader_options(CLI::App& command, SequenceOptions& options) {
  command.add_option("--format", options.format, sequence_format_list())
      ->check(recording_format())
      ->capture_default_str();
  command.add_option("--calibration", options.calibration,
                     "camera preset or YAML file (default: by format)");
  command.add_option("--color-topic", options.color_topic,
                     "topic of the colour images in a bag (default: the likeliest)");
  command.add_option("--depth-topic", options.depth_topic,
                     "topic of the depth images in a bag (default: the likeliest)");
}

}  // namespace dxslam::apps
