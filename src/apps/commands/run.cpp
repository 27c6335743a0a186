// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <filesystem>
#include <future>

#include "apps/commands.h"
#include "apps/console.h"
#include "apps/map_io.h"
#include "apps/process.h"
#include "apps/progress.h"
#include "apps/run_output.h"
#include "apps/run_settings.h"
#include "apps/stoppable_sequence.h"
#include "apps/system_setup.h"
#include "apps/thumbnails.h"
#include "apps/usage.h"
#include "features/extractor_factory.h"
#include "io/formats/trajectory_file.h"
#include "io/primitives/atomic_file.h"
#include "slam/system.h"
#include "synthetic/low_light.h"

namespace dxslam::apps {
namespace {

constexpr int kThumbnailsTidied = 100;    // keyframes between two times that old ones are let go
constexpr double kMinTrackedShare = 0.1;  // below it the run counts as failed

SystemOptions options_of(const RunSettings& settings) {
  SystemOptions options = load_system_options(
      {settings.config, settings.features, settings.mode, settings.deterministic});
  if (!settings.vocabulary.empty()) options.vocabulary = settings.vocabulary;
  if (settings.no_loop_closing) options.close_loops = false;
  return options;
}

const char* state_name(TrackingState state) {
  switch (state) {
    case TrackingState::kTracking:
      return "tracking";
    case TrackingState::kLost:
      return "lost";
    default:
      return "starting";
  }
}

// Waits until the recording's own clock has come to `stamp`, or for the stop.
class RealTimePace {
 public:
  void wait_for(double stamp) {
    if (first_stamp_ < 0.0) first_stamp_ = stamp;
    sleep_until(start_ + std::chrono::duration_cast<Clock::duration>(std::min(
                             std::chrono::duration<double>(stamp - first_stamp_), kLongest)));
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::duration<double> kLongest{1e9};  // what a clock can hold

  Clock::time_point start_ = Clock::now();
  double first_stamp_ = -1.0;
};

void feed(const RunSettings& settings, RgbdSequence& sequence, System& system,
          Thumbnails& thumbnails, RunRecord& record) {
  const std::optional<LowLight> low_light =
      settings.low_light ? std::optional<LowLight>(LowLight(*settings.low_light)) : std::nullopt;
  RealTimePace pace;
  for (std::size_t i = 0; i < sequence.size(); i += settings.stride) {
    if (settings.max_frames > 0 && record.frames_offered >= settings.max_frames) break;
    std::optional<RgbdImage> image = sequence.read(i);
    if (stop_requested()) break;
    ++record.frames_offered;
    if (!image) continue;
    if (low_light) image->color = low_light->apply(image->color, image->index);
    thumbnails.offer(*image);
    if (!settings.realtime) {
      system.process(*image);
      continue;
    }
    pace.wait_for(image->stamp);
    if (stop_requested()) break;
    if (!system.try_process(*image)) ++record.frames_dropped;
  }
  system.finish([] { return !stop_requested(); });
  record.interrupted = stop_requested();
}

std::size_t planned_frames(const RunSettings& settings, const RgbdSequence& sequence) {
  const std::size_t n = (sequence.size() + settings.stride - 1) / settings.stride;
  return settings.max_frames > 0 ? std::min(n, settings.max_frames) : n;
}

void print_outcome(const RunSettings& settings, const RunRecord& record,
                   const RgbdSequence& sequence, const System& system) {
  const auto stages = system.times().summaries();
  const auto frame = stages.find("frame");
  print(
      "{} of {} frames tracked, {} keyframes, {} points; {:.1f} ms per frame ({}), {:.1f} s in "
      "all\n",
      tracked_frames(system), record.frames_offered, system.map().keyframe_count(),
      system.map().point_count(), frame == stages.end() ? 0.0 : frame->second.median_ms,
      system.extractor().name(), record.wall_s);
  if (!sequence.skipped().empty()) {
    const SkippedFrame& first = sequence.skipped().front();
    warn("{} frames were skipped; the first, {}: {}", sequence.skipped().size(), first.index,
         first.reason);
  }
  if (record.frames_dropped > 0) {
    warn("{} frames came too fast and were dropped", record.frames_dropped);
  }
  if (!settings.out.empty()) print("results in {}\n", settings.out);
}

void check_map_settings(const RunSettings& settings, const SystemOptions& options) {
  if (options.mode == "localization" && settings.map_in.empty()) {
    throw InputError("mode localization has no map, expected --map-in FILE");
  }
  if (settings.autosave > 0 && settings.map_out.empty()) {
    throw InputError("--autosave has nowhere to save to, expected --map-out FILE");
  }
  if (settings.thumbnails && settings.map_out.empty()) {
    throw InputError("--thumbnails has no map to be put into, expected --map-out FILE");
  }
}

int run(const RunSettings& settings) {
  const Stopwatch startup;
  const SystemOptions options = options_of(settings);
  check_map_settings(settings, options);
  const std::unique_ptr<RgbdSequence> sequence =
      stoppable(open_sequence(settings.sequence, settings.reader));
  std::future<StoredMap> loading;  // while the network is made ready
  if (!settings.map_in.empty()) {
    loading = std::async(std::launch::async, load_map, settings.map_in);
  }
  std::unique_ptr<TrajectoryWriter> writer;
  if (!settings.out.empty()) {
    make_folder(settings.out);
    writer =
        std::make_unique<TrajectoryWriter>(std::filesystem::path(settings.out) / "trajectory.txt");
  }
  Progress progress("frames", planned_frames(settings, *sequence));
  std::size_t done = 0;
  RunRecord record;
  std::optional<Thumbnails> thumbnails;
  System system(sequence->camera(), make_extractor(options.features, options.extractor), options,
                [&](const TrackedFrame& frame) {
                  thumbnails->note(frame);
                  if (frame.state == TrackingState::kTracking) {
                    if (!record.first_pose_ms) record.first_pose_ms = startup.ms();
                    if (writer) writer->append({frame.stamp, frame.world_from_camera});
                  }
                  progress.update(++done, state_name(frame.state));
                });
  const MapHeader header = map_header(sequence->camera(), system.extractor());
  std::vector<std::string> stored;
  if (!settings.map_in.empty()) {
    stored = hand_over(loading.get(), system, settings.map_in, header, options.mode == "slam");
  }
  thumbnails.emplace(settings.thumbnails, std::move(stored));
  AutoSaver saver(settings.map_out, header);
  if (settings.autosave > 0 || settings.thumbnails) {
    const int every = settings.autosave > 0 ? settings.autosave : kThumbnailsTidied;
    system.set_autosave(every, [&](const Map& map, const std::vector<LoopEdge>& loops) {
      thumbnails->forget_culled(map);
      if (settings.autosave > 0) saver.save(map, loops, thumbnails->of(map));
    });
  }
  record.startup_ms = startup.ms();
  const Stopwatch wall;
  std::optional<Unsaved> unsaved(std::in_place);
  feed(settings, *sequence, system, *thumbnails, record);
  record.wall_s = wall.ms() / 1000.0;
  progress.finish();
  if (!settings.map_out.empty()) {
    saver.finish();
    save_system_map(settings.map_out, header, system.map(), system.backend().closed_loops(),
                    thumbnails->of(system.map()));
  }
  if (!settings.out.empty()) {
    write_results(settings.out, settings, record, options, *sequence, system);
  }
  unsaved.reset();
  print_outcome(settings, record, *sequence, system);
  if (record.interrupted) return kInterrupted;
  const double share = static_cast<double>(tracked_frames(system)) /
                       static_cast<double>(std::max<std::size_t>(1, record.frames_offered));
  return share < kMinTrackedShare ? kTrackingFailed : kSuccess;
}

}  // namespace

void add_run_command(CLI::App& app) {
  auto settings = std::make_shared<RunSettings>();
  CLI::App* command = app.add_subcommand("run", "Track a recording and build its map");
  command->add_option("SEQUENCE", settings->sequence, "Folder of the recording")->required();
  command
      ->add_option("--format", settings->reader.format, "auto, tum, 7scenes, openloris or folder")
      ->capture_default_str();
  command->add_option("--calibration", settings->reader.calibration,
                      "Camera preset or YAML file (default: by format)");
  command->add_option("--association", settings->reader.association,
                      "File that pairs colour with depth images");
  command->add_option("--config", settings->config, "YAML file; see `dxslam config dump`");
  command->add_option("--features", settings->features, "Extractor name or model manifest");
  command->add_option("--out", settings->out, "Folder for trajectory, map and summary");
  command->add_option("--mode", settings->mode, "slam, or localization in the map of --map-in");
  command->add_option("--map-in", settings->map_in, "Go on with this map");
  command->add_option("--map-out", settings->map_out, "Save the map here");
  command
      ->add_option("--autosave", settings->autosave,
                   "Save it after every so many keyframes as well, not only at the end")
      ->check(whole_number(1));
  command->add_flag("--thumbnails", settings->thumbnails,
                    "Put small pictures of the keyframes into it, 3 to 6 KiB each");
  command->add_option("--vocabulary", settings->vocabulary,
                      "FBoW or DBoW2 file; none: loops by global descriptor alone");
  command->add_flag("--no-loop-closing", settings->no_loop_closing, "Do not look for loops");
  command->add_option("--stride", settings->stride, "Use every n-th frame")->check(whole_number(1));
  command->add_option("--max-frames", settings->max_frames, "Stop after so many frames")
      ->check(whole_number(0));
  command
      ->add_option_function<double>(
          "--low-light", [settings](double gain) { settings->low_light = gain; },
          "Darken the images first (low-light model)")
      ->expected(0, 1)
      ->check(low_light_gain())
      ->default_str(fmt::format("{}", LowLight::kDefaultGain))
      ->type_name("[=GAIN]");
  command->add_flag("--realtime", settings->realtime,
                    "Feed images at their own pace, dropping late ones");
  command->add_flag("--deterministic", settings->deterministic,
                    "One thread, exact arithmetic: the same result every time");
  command->callback([settings] {
    if (const int code = run(*settings); code != kSuccess) throw CLI::RuntimeError(code);
  });
}

}  // namespace dxslam::apps
