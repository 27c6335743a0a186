// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/sources/open_source.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "core/error.h"
#include "io/sources/live_source.h"
#include "io/sources/v4l2_camera.h"

namespace dxslam {
namespace {

/// All that programs say of a kind of camera, and do with it, comes from its row.
struct Kind {
  const char* name;
  const char* example;  // with what it is
  std::unique_ptr<LiveCamera> (*open)(const SourceName& name, const std::string& calibration);
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> table = {
      {"v4l2", "v4l2:/dev/video4,/dev/video2?fps=30 (video devices of colour and depth)",
       [](const SourceName& name, const std::string& calibration) {
         return open_v4l2(name, calibration);
       }},
  };
  return table;
}

const Kind* kind_of(const std::string& name) {
  const auto found = std::find_if(kinds().begin(), kinds().end(), [&](const Kind& kind) {
    return name.rfind(std::string(kind.name) + ":", 0) == 0;
  });
  return found == kinds().end() ? nullptr : &*found;
}

void refuse_options_of_recordings(const std::string& name, const SequenceOptions& options) {
  const SequenceOptions none;
  for (const auto& [option, given] : {std::pair("--format", options.format != none.format),
                                      std::pair("--association", !options.association.empty()),
                                      std::pair("--color-topic", !options.color_topic.empty()),
                                      std::pair("--depth-topic", !options.depth_topic.empty()),
                                      std::pair("--eye", options.eye != none.eye)}) {
    if (!given) continue;
    throw InputError(
        fmt::format("option {} is for recordings, expected none for the camera {}", option, name));
  }
}

}  // namespace

bool is_live_source(const std::string& name) { return kind_of(name) != nullptr; }

std::string known_live_sources() {
  std::vector<const char*> examples;
  for (const Kind& kind : kinds()) examples.push_back(kind.example);
  return fmt::format("{}", fmt::join(examples, ", "));
}

std::unique_ptr<ImageSource> open_live_source(const std::string& name,
                                              const SequenceOptions& options,
                                              const ImageSelection& selection) {
  const Kind* const kind = kind_of(name);
  if (kind == nullptr) {
    throw InputError(
        fmt::format("{}: no camera known here, expected {}", name, known_live_sources()));
  }
  refuse_options_of_recordings(name, options);
  LiveOptions live;
  live.max_association_s = options.max_association_s;
  return make_live_source(name, kind->open(SourceName(name), options.calibration), selection, live);
}

std::unique_ptr<ImageSource> open_source(const std::string& name, const SequenceOptions& options,
                                         const ImageSelection& selection) {
  if (is_live_source(name)) return open_live_source(name, options, selection);
  return make_image_source(open_sequence(name, options), selection);
}

}  // namespace dxslam
