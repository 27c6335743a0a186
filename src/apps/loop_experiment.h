// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/sequence.h"
#include "evaluation/loop_truth.h"
#include "evaluation/loop_truth_from_poses.h"
#include "features/extractor_options.h"
#include "io/recordings/sequence_reader.h"
#include "place/loop_detector.h"

namespace dxslam::apps {

/// A run of loop detectors over the images of a recording.
struct LoopSettings {
  std::string sequence;
  SequenceOptions reader;
  std::string truth;  ///< "poses" or a file
  PoseLoopOptions poses;
  std::vector<std::string> methods;
  LoopDetectorOptions detector;  ///< the method aside
  std::string features;          ///< of all methods but orb-bow; the default extractor where empty
  ExtractorOptions extractor;
  std::string hf_vocabulary;   ///< file; the one shipped for the extractor where empty
  std::string orb_vocabulary;  ///< likewise
  std::string out;
  std::size_t stride = 1;
  std::size_t max_frames = 0;                   ///< 0 = all
  std::optional<std::size_t> low_light_from;    ///< images from this frame on are darkened
  double low_light_gain = 0.0;                  ///< 0 = the default of LowLight
  std::optional<std::size_t> second_pass_from;  ///< frames before it are places, others queries
};

struct LoopQuery {
  std::size_t frame = 0;
  std::vector<LoopCandidate> candidates;  ///< best first
  double ms = 0.0;                        ///< words, search and geometry; not the extraction
};

struct MethodRun {
  LoopDetectorOptions options;
  std::size_t words = 0;  ///< of the vocabulary; 0 where there is none
  std::vector<LoopQuery> queries;
};

struct LoopExperiment {
  std::vector<std::size_t> queries;  ///< frames that were asked for
  std::vector<std::size_t> places;   ///< frames that could be found
  std::vector<MethodRun> runs;       ///< one per method
  std::string hf_name;               ///< of the extractor; empty where no method needs it
  std::vector<double> hf_ms;         ///< extraction, by image
  std::vector<double> orb_ms;
  /// By frame of the recording; nothing without depth or pose, or where the image was not used.
  std::vector<std::optional<DepthView>> views;
  std::vector<SkippedFrame> failed;  ///< images whose features could not be extracted
  bool interrupted = false;          ///< by a stop: the rest of the images was not asked for
};

/// Asks every detector for every image, then makes the image a place. Views less than
/// `poses.window` seconds old are never found. Images that cannot be read or
/// worked on are left out. `progress(done, total)` is called before each image. Ends early at a
/// stop (process.h).
LoopExperiment run_loop_experiment(const LoopSettings& settings, RgbdSequence& sequence,
                                   const std::function<void(std::size_t, std::size_t)>& progress);

/// The true loops between the frames of the recording, from its poses (and `views` of the
/// experiment) or the file. A matrix of twice as many frames is one of left and right in turn, one
/// of half as many has one frame a place. Throws InputError if it does not fit.
LoopTruth load_loop_truth(const LoopSettings& settings, const RgbdSequence& sequence,
                          const std::vector<std::optional<DepthView>>& views);

}  // namespace dxslam::apps
