// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>

#include "core/options.h"
#include "features/extractor_options.h"
#include "loop_closing/loop_closing_options.h"
#include "mapping/mapping_options.h"
#include "place/loop_options.h"
#include "relocalization/relocalization_options.h"
#include "tracking/tracker_options.h"

namespace dxslam {

/// Everything that can be set about the system; one default for every recording of a sensor.
struct SystemOptions {
  std::string features = "auto";
  std::string features_note;  ///< not an option: what is to be said about the choice of `auto`
  std::string mode = "slam";
  std::string vocabulary = "auto";
  bool close_loops = true;
  double loop_relaxation = 1.0;
  int new_map_after = 20;
  bool deterministic = false;
  int queued_frames = 1;
  int queued_keyframes = 1;
  bool final_bundle = true;
  BundleOptions full_bundle{20, 20};
  ExtractorOptions extractor;
  TrackerOptions tracking;
  MappingOptions mapping;
  LoopOptions loop_detection;
  LoopCloserOptions loop_closing;
  RelocalizationOptions relocalization;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit(for_users("features"), self.features, "",
          "extractor name or manifest file; auto: the best installed");
    visit(for_users("mode"), self.mode, "",
          "slam, or localization: poses in a given map, which stays as it is");
    visit(for_users("vocabulary"), self.vocabulary, "",
          "file; auto: the one shipped for the features; none: loops by global descriptor alone");
    visit(for_users("close_loops"), self.close_loops, "",
          "look for loops and correct the map by them");
    visit(
        "loop_relaxation", self.loop_relaxation, {1, 10}, "",
        "factor that loosens the thresholds of loop_detection; geometry has the last word anyway");
    visit(for_users("new_map_after"), self.new_map_after, {1, 1000000}, "frames",
          "lost in a row, with things to see, before a new map is begun beside the old one (slam)");
    visit(for_users("deterministic"), self.deterministic, "",
          "one thread and exact arithmetic: repeatable to the bit");
    visit(for_users("queued_frames"), self.queued_frames, {1, 1000}, "frames",
          "most that wait to be tracked");
    visit(for_users("queued_keyframes"), self.queued_keyframes, {1, 1000}, "keyframes",
          "most keyframes that wait for mapping");
    visit(for_users("final_bundle"), self.final_bundle, "",
          "adjust the whole map once more at the end");
    visit.group("full_bundle", self.full_bundle);
    visit.group("extractor", self.extractor);
    visit.group("tracking", self.tracking);
    visit.group("mapping", self.mapping);
    visit.group("loop_detection", self.loop_detection);
    visit.group("loop_closing", self.loop_closing);
    visit.group("relocalization", self.relocalization);
  }
};

/// Throws InputError for what no system can be made with: numbers out of range, unknown names.
void validate_system_options(const SystemOptions& options);

}  // namespace dxslam
