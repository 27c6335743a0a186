// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include "apps/commands.h"
#include "apps/console.h"
#include "apps/open_recording.h"
#include "apps/process.h"
#include "apps/progress.h"
#include "apps/run_output.h"
#include "apps/session.h"
#include "apps/stoppable_sequence.h"
#include "apps/usage.h"
#include "core/error.h"
#include "core/image_source.h"
#include "slam/stage_times.h"
#include "synthetic/low_light.h"

namespace dxslam::apps {
namespace {

constexpr double kLongestGap = 3600.0;  // seconds between two frames in real time

struct RunArguments {
  RunSettings settings;
  std::string sequence;
  std::size_t max_frames = 0;  ///< 0: all
  std::optional<double> low_light;
  bool realtime = false;
};

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
    if (!first_stamp_) first_stamp_ = stamp;
    sleep_until(start_ + std::chrono::duration_cast<Clock::duration>(std::min(
                             std::chrono::duration<double>(stamp - *first_stamp_), kLongest)));
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::duration<double> kLongest{1e9};  // what a clock can hold

  Clock::time_point start_ = Clock::now();
  std::optional<double> first_stamp_;
};

// Stamps in nanoseconds would take years.
void require_pace(const RgbdSequence& sequence) {
  for (std::size_t i = 1; i < sequence.size(); ++i) {
    const double gap = sequence.stamp(i) - sequence.stamp(i - 1);
    if (gap <= kLongestGap) continue;
    throw InputError(fmt::format(
        "{}: with --realtime, frame {} would be waited for for {:.3g} s, expected stamps "
        "in seconds, at most {:g} s apart",
        sequence.name(), i, gap, kLongestGap));
  }
}

void feed(const RunArguments& arguments, ImageSource& source, Session& session, RunRecord& record) {
  const std::optional<LowLight> low_light =
      arguments.low_light ? std::optional<LowLight>(LowLight(*arguments.low_light)) : std::nullopt;
  const bool live = arguments.realtime || source.is_live();
  RealTimePace pace;
  const auto give = [&](RgbdImage& image) {
    if (low_light) image.color = low_light->apply(image.color, image.index);
    if (arguments.realtime) pace.wait_for(image.stamp);
    if (stop_requested()) return;
    if (!session.process(image, live)) ++record.frames_dropped;
  };
  bool goes_on = true;
  while (goes_on) {
    std::optional<RgbdImage> image = session.next(source, record.failed_images);
    if (!image) return;
    goes_on = session.attempt(source.index(), record.failed_images, [&] { give(*image); });
  }
}

// As they were known when the frames were tracked, whichever map they are in.
Trajectory poses_as_tracked(const System& system) {
  Trajectory poses;
  system.frames().for_each([&](const TrackedFrame& frame) {
    if (frame.state != TrackingState::kTracking) return;
    poses.push_back({frame.stamp, frame.world_from_camera});
  });
  return poses;
}

void count_tracked(const System& system, RunRecord& record) {
  record.frames_tracked = 0;
  for (const ComponentSummary& component : system.components()) {
    record.frames_tracked += component.frames;
    record.maps += component.frames > 0 ? 1 : 0;
  }
}

void conclude(const ImageOrigin& sequence, const Session& session, RunRecord& record) {
  if (session.system() == nullptr) return;
  const System& system = *session.system();
  record.trajectory = session.has_whole_map() ? system.trajectory() : poses_as_tracked(system);
  record.frames_tracked = record.trajectory.size();
  if (session.has_whole_map()) count_tracked(system, record);
  record.truth = compare_with_truth(sequence, record.trajectory);
}

void print_outcome(const RunRecord& record, const ImageOrigin& sequence, const Session& session) {
  if (const System* system = session.system()) {
    const auto stages = session.statistics().stages();
    const auto frame = stages.find("frame");
    const bool whole = system->map_is_whole();
    print("{} of {} tracked{}, {}, {}; {:.1f} ms per frame ({}), {:.1f} s in all\n",
          record.frames_tracked, counted(record.frames_offered, "frame"),
          record.maps > 1 ? fmt::format(" in {} maps", record.maps) : "",
          counted(whole ? system->map().keyframe_count() : 0, "keyframe"),
          counted(whole ? system->map().point_count() : 0, "point"),
          frame == stages.end() ? 0.0 : frame->second.median_ms, system->extractor().name(),
          record.wall_s);
  }
  if (record.maps > 1) {
    warn(
        "the maps were not joined: {} of the tracked frames are in trajectory.txt, the others in "
        "trajectory_mapN.txt",
        record.trajectory.size());
  }
  if (record.truth) print_truth(*record.truth, sequence.camera());
  print_skipped(all_skipped(sequence, record.failed_images));
  if (record.frames_dropped > 0) {
    warn("frames that came too fast and were dropped: {}", record.frames_dropped);
  }
}

// Whatever went wrong before: what can be saved is saved.
int end(const ImageOrigin& sequence, Session& session, OnlineTrajectory& online,
        RunRecord& record) {
  record.interrupted = stop_requested();
  record.why_no_pose = session.why_no_pose();
  record.reader_failures = session.tell_reader_failures();
  OutputSteps steps;
  if (!steps.run([&] { session.rethrow_error(); })) record.error = steps.failures().front();
  session.save_map(steps);
  steps.run([&] { conclude(sequence, session, record); });
  write_results(steps, session, online, record, sequence);
  session.all_is_saved();
  print_outcome(record, sequence, session);
  const int code = judge_tracking(record.frames_tracked, record.frames_offered, record.why_no_pose);
  if (session.folder() != nullptr) steps.tell_place(session.folder()->path());
  session.tell_map();
  return session.end(steps, record.interrupted ? kInterrupted : code);
}

std::unique_ptr<ImageSource> open_images_of(const RunArguments& arguments) {
  const SequenceOptions& options = arguments.settings.reader;
  const ImageSelection selection{arguments.settings.stride, arguments.max_frames};
  if (!arguments.realtime) return open_images(arguments.sequence, options, selection);
  auto recording = stoppable(open_recording(arguments.sequence, options));  // a camera has a pace
  require_pace(*recording);
  return make_image_source(std::move(recording), selection);
}

// Those that were left out as it was opened (stamps that come again) are frames that it never came
// to.
std::size_t frames_offered(const ImageSource& source, std::size_t left_out,
                           const RunArguments& arguments) {
  const bool all = arguments.max_frames == 0 && source.planned() == source.passed();
  return source.passed() + (all ? left_out / arguments.settings.stride : 0);
}

int run(const RunArguments& arguments) {
  const Stopwatch startup;
  Session session(arguments.settings);
  const std::unique_ptr<ImageSource> source = open_images_of(arguments);
  require_depth(*source);
  const std::size_t left_out = source->skipped().size();
  session.claim_targets();
  OnlineTrajectory online(session.folder(), "trajectory.txt");
  Progress progress("frames", source->planned().value_or(0));
  std::size_t done = 0;
  RunRecord record;
  record.low_light = arguments.low_light;
  record.realtime = arguments.realtime;
  const auto system = session.start(source->camera(), [&](const Message& message) {
    const auto* tracked = std::get_if<FrameTracked>(&message.event);
    if (tracked == nullptr) return;
    const TrackedFrame& frame = tracked->frame;
    if (frame.state == TrackingState::kTracking) {
      if (!record.first_pose_ms) record.first_pose_ms = startup.ms();
      online.append({frame.stamp, frame.world_from_camera});
    }
    progress.update(++done, state_name(frame.state));
  });
  print_recording(*source);
  record.startup_ms = startup.ms();
  const Stopwatch wall;
  session.run([&] { feed(arguments, *source, session, record); });
  record.wall_s = wall.ms() / 1000.0;
  record.frames_offered = frames_offered(*source, left_out, arguments);
  record.frames_dropped += source->dropped();
  progress.finish();
  return end(*source, session, online, record);
}

}  // namespace

void add_run_command(CLI::App& app) {
  auto arguments = std::make_shared<RunArguments>();
  RunSettings& settings = arguments->settings;
  CLI::App* command = app.add_subcommand("run", "track a recording and build its map");
  command->add_option("SEQUENCE", arguments->sequence, source_help())->required();
  command->add_option("--out", settings.out, "folder for trajectory, map and summary");
  add_run_options(*command, settings);
  command->add_option("--association", settings.reader.association,
                      "file that pairs colour with depth images");
  command->add_flag("--thumbnails", settings.thumbnails,
                    "put small pictures of the keyframes into the map, 3 to 6 KiB each");
  command
      ->add_option("--max-frames", arguments->max_frames, "stop after so many frames, 0 = use all")
      ->check(whole_number(0));
  command
      ->add_option_function<double>(
          "--low-light", [arguments](double gain) { arguments->low_light = gain; },
          "darken the images first (low-light model)")
      ->expected(0, 1)
      ->check(low_light_gain())
      ->default_str(fmt::format("{}", LowLight::kDefaultGain))
      ->type_name("[=GAIN]");
  command->add_flag("--realtime", arguments->realtime,
                    "feed images at their own pace, dropping late ones");
  command->callback([arguments] {
    if (const int code = run(*arguments); code != kSuccess) throw CLI::RuntimeError(code);
  });
}

}  // namespace dxslam::apps
