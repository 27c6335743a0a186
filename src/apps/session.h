// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/first_pose_report.h"
#include "apps/map_io.h"
#include "apps/map_target.h"
#include "apps/output_steps.h"
#include "apps/process.h"
#include "apps/recording_report.h"
#include "apps/run_settings.h"
#include "apps/thumbnails.h"
#include "core/image_source.h"
#include "io/primitives/result_folder.h"
#include "slam/event_reader.h"
#include "slam/first_error.h"
#include "slam/run_statistics.h"
#include "slam/system.h"

namespace dxslam::apps {

/// What `dxslam run` and `dxslam lifelong` do alike around the system: options, targets, the
/// network and the map it goes on with, saving. The steps in order: construction, claim_targets(),
/// start(), run(), outputs.
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

  /// Loads network and map, and returns the system, which this uses from then on: what `receive`
  /// uses must outlive it, and so must this. Null if a stop was requested before all was loaded.
  /// `receive` gets the messages of the system, in a thread of their own, all of those of
  /// kReceived. Throws InputError for what cannot be used.
  std::unique_ptr<System> start(const Camera& camera, EventReader::Function receive);
  /// Small ones alone, for none may be lost.
  static constexpr EventKinds kReceived = RunStatistics::kinds() | EventKinds::of<RecordingBegun>();
  /// Null where there is none.
  System* system() { return system_; }
  const System* system() const { return system_; }

  /// Calls `feed`, which gives the images, and waits until all are worked off and told. What goes
  /// wrong inside ends them, but costs no output: see rethrow_error(). Does nothing without a
  /// system.
  void run(const std::function<void()>& feed);
  /// In `feed`: next_image(), told to those who receive messages.
  std::optional<RgbdImage> next(ImageSource& source, std::vector<SkippedFrame>& failed);
  /// In `feed`, once per image: calls `work`, which processes it. What that throws costs this image
  /// alone (see ImageAttempts), and is added to `failed`. Returns whether further images are
  /// wanted: not after a stop, nor once tracking or mapping has failed.
  bool attempt(std::size_t index, std::vector<SkippedFrame>& failed,
               const std::function<void()>& work);
  /// In `work`: hands an image to the system; false if it was dropped (`live` only).
  bool process(const RgbdImage& image, bool live);

  /// Throws what ended the images early. After run(), as all below.
  void rethrow_error() const { error_.rethrow(); }
  /// What those who received messages have failed with; says it on stderr.
  CallbackFailures tell_reader_failures() const;
  const RunStatistics& statistics() const { return statistics_; }
  /// Whether the map can be read: no change of it has failed halfway.
  bool has_whole_map() const { return system_ != nullptr && system_->map_is_whole(); }
  /// Why there is no pose at all; nothing if there is one.
  std::optional<std::string> why_no_pose() const;
  /// Saves the map where that was asked for. An empty one is not saved, nor one that is not whole;
  /// that is said.
  void save_map(OutputSteps& steps);
  /// Says on stdout where the map was saved; nothing where none was.
  void tell_map() const;
  /// Ends the command, which has come to the exit code `code`: says what failed, and after exit
  /// code 0 lets go of the last results and of the map of before; else it says where those are
  /// kept. Returns the exit code.
  int end(const OutputSteps& steps, int code);
  /// All outputs are written: from here on a stop need not wait for this any more.
  void all_is_saved() { unsaved_.reset(); }

 private:
  void note(const Event& event);
  void tell_unreadable(const SkippedFrame& skipped);

  RunSettings settings_;
  SystemOptions options_;
  std::optional<ResultFolder> folder_;
  std::optional<MapTarget> map_target_;  // after the folder, in which it may lie
  FirstPoseReport first_pose_;
  std::optional<Thumbnails> thumbnails_;
  std::optional<AutoSaver> saver_;
  MapHeader header_;
  std::optional<std::string> other_camera_;  // says that the map was made with one
  double max_depth_ = 0.0;                   // of the camera, metres
  bool map_is_saved_ = false;
  System* system_ = nullptr;
  bool given_ = false;  // the image in work, to the system
  RunStatistics statistics_;
  std::optional<EventReader> reader_;  // the last of those that its thread uses
  ImageAttempts attempts_;
  FirstError error_;
  std::optional<Unsaved> unsaved_;
};

/// The exit code of a run in which `tracked` of `frames` frames have a pose, if nothing else went
/// wrong; says so on stderr if these are too few. `why_no_pose`: as Session has it.
int judge_tracking(std::size_t tracked, std::size_t frames,
                   const std::optional<std::string>& why_no_pose);

}  // namespace dxslam::apps
