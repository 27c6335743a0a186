// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>

#include "features/extractor_options.h"
#include "mapping/mapping_options.h"
#include "tracking/tracker_options.h"

namespace dxslam {

/// Everything that can be set about the system; one default for every recording of a sensor.
struct SystemOptions {
  std::string features = "auto";
  bool deterministic = false;
  int queued_frames = 2;
  int queued_keyframes = 1;
  bool final_bundle = true;
  BundleOptions full_bundle{20, 20};
  ExtractorOptions extractor;
  TrackerOptions tracking;
  MappingOptions mapping;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("features", self.features, "",
          "extractor name or manifest file; auto: the best installed");
    visit("deterministic", self.deterministic, "",
          "one thread and exact arithmetic: repeatable to the bit");
    visit("queued_frames", self.queued_frames, {1, 1000}, "frames",
          "most frames that wait between two threads");
    visit("queued_keyframes", self.queued_keyframes, {1, 1000}, "keyframes",
          "most keyframes that wait for mapping");
    visit("final_bundle", self.final_bundle, "", "adjust the whole map once more at the end");
    visit.group("full_bundle", self.full_bundle);
    visit.group("extractor", self.extractor);
    visit.group("tracking", self.tracking);
    visit.group("mapping", self.mapping);
  }
};

}  // namespace dxslam
