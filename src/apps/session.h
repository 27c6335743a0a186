// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "apps/first_pose_report.h"
#include "apps/map_io.h"
#include "apps/output_steps.h"
#include "apps/process.h"
#include "apps/run_settings.h"
#include "apps/thumbnails.h"
#include "io/primitives/result_folder.h"
#include "slam/system.h"

namespace dxslam::apps {

/// What `dxslam run` and `dxslam lifelong` do alike around the system: options, targets, the
/// network and the map it goes on with, saving. The steps in order: construction, claim_targets(),
/// start(), images, finish(), outputs.
class Session {
 public:
  /// Makes nothing yet. Throws InputError for settings that cannot be used.
  explicit Session(const RunSettings& settings);

  const RunSettings& settings() const { return settings_; }
  const SystemOptions& options() const { return options_; }

  /// Tries whether all that was asked for can be written, before anything costs time: throws
  /// InputError if not. Changes nothing. From here on a stop waits for the outputs.
  void claim_targets();
  /// The folder of results; null where none was asked for.
  ResultFolder* folder() { return folder_ ? &*folder_ : nullptr; }

  /// Loads network and map, and returns the system, which this uses from then on: what `on_frame`
  /// uses must outlive it, and so must this. Null if a stop was requested before all was loaded.
  /// Throws InputError for what cannot be used.
  std::unique_ptr<System> start(const Camera& camera, System::FrameCallback on_frame);
  /// Null where there is none.
  System* system() { return system_; }
  const System* system() const { return system_; }

  /// Hands an image to the system; false if it was dropped (`live` only).
  bool process(const RgbdImage& image, bool live);
  /// Waits until all images are worked off.
  void finish();

  /// Why there is no pose at all; nothing if there is one. After finish().
  std::optional<std::string> why_no_pose() const;
  /// Saves the map where that was asked for. An empty one is not saved, which is said. After
  /// finish().
  void save_map(OutputSteps& steps);
  /// All outputs are written: from here on a stop need not wait for this any more.
  void all_is_saved() { unsaved_.reset(); }

 private:
  RunSettings settings_;
  SystemOptions options_;
  std::optional<ResultFolder> folder_;
  FirstPoseReport first_pose_;
  std::optional<Thumbnails> thumbnails_;
  std::optional<AutoSaver> saver_;
  MapHeader header_;
  System* system_ = nullptr;
  std::optional<Unsaved> unsaved_;
};

/// The exit code of a run in which `tracked` of `frames` frames have a pose, if nothing else went
/// wrong; says so on stderr if these are too few. `why_no_pose`: as Session has it.
int judge_tracking(std::size_t tracked, std::size_t frames,
                   const std::optional<std::string>& why_no_pose);

}  // namespace dxslam::apps
