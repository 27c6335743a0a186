// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <deque>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/commands.h"
#include "apps/console.h"
#include "apps/online_trajectory.h"
#include "apps/open_recording.h"
#include "apps/process.h"
#include "apps/progress.h"
#include "apps/recording_report.h"
#include "apps/session.h"
#include "apps/stoppable_sequence.h"
#include "apps/usage.h"
#include "core/error.h"
#include "core/image_source.h"
#include "evaluation/openloris_result.h"
#include "io/primitives/atomic_file.h"
#include "io/primitives/json_text.h"
#include "synthetic/low_light.h"

namespace dxslam::apps {
namespace {

using Json = nlohmann::ordered_json;

struct LifelongArguments {
  RunSettings settings;
  std::vector<std::string> sequences;
  std::string scene = "scene";
  std::string frame = "d400_color";
  std::vector<int> low_light;  ///< numbers of the sequences that are darkened
};

/// One recording as it is fed.
struct Visit {
  Visit(const ImageOrigin& fed, ResultFolder* folder, std::size_t number)
      : recording(fed), first(number == 1), file(folder, fmt::format("online_{}.txt", number)) {}

  const ImageOrigin& recording;
  const bool first;
  std::size_t frames = 0;
  double first_stamp = 0.0;
  std::vector<SkippedFrame> failed;
  std::size_t tracked = 0;           ///< of them, and so in System::frames()
  std::size_t localized = 0;         ///< frames with a pose in the first map's world
  std::optional<double> first_pose;  ///< its stamp
  OnlineTrajectory file;             ///< these poses, as given at the time
};

using Recordings = std::vector<std::unique_ptr<ImageSource>>;

// Both become part of a file of lines and, the scene, of its name.
void check_name(const char* option, const std::string& name) {
  const auto fits = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.';
  };
  if (!name.empty() && std::all_of(name.begin(), name.end(), fits)) return;
  throw InputError(
      fmt::format("{} is '{}', expected letters, digits, '-', '_' and '.' alone", option, name));
}

Recordings open_all(const LifelongArguments& arguments) {
  for (const int number : arguments.low_light) {
    if (static_cast<std::size_t>(number) <= arguments.sequences.size()) continue;
    throw InputError(fmt::format("--low-light-in {}: expected the number of a sequence, 1 to {}",
                                 number, arguments.sequences.size()));
  }
  Recordings all;
  for (const std::string& folder : arguments.sequences) {
    auto recording = stoppable(open_recording(folder, arguments.settings.reader));
    require_depth(*recording);
    all.push_back(make_image_source(std::move(recording), {arguments.settings.stride, 0}));
    const Camera& first = all.front()->camera();
    const Camera& camera = all.back()->camera();
    if (!camera.sees_as(first)) {
      throw InputError(fmt::format("{}: has another camera than {}, expected one camera for all",
                                   folder, arguments.sequences.front()));
    }
  }
  return all;
}

void feed(ImageSource& source, bool dark, Session& session, Visit& visit) {
  const LowLight low_light(LowLight::kDefaultGain);
  const auto give = [&](RgbdImage& image) {
    if (dark) image.color = low_light.apply(image.color, image.index);
    if (visit.frames++ == 0) visit.first_stamp = image.stamp;
    session.process(image, false);
  };
  bool goes_on = true;
  while (goes_on) {
    std::optional<RgbdImage> image = session.next(source, visit.failed);
    if (!image) return;
    goes_on = session.attempt(source.index(), visit.failed, [&] { give(*image); });
  }
}

// `begun` counts the recordings it came to.
void feed_all(const LifelongArguments& arguments, const Recordings& recordings, Session& session,
              std::deque<Visit>& visits, std::size_t& begun) {
  System& system = *session.system();
  for (std::size_t v = 0; v < recordings.size() && !stop_requested() && !system.has_failed(); ++v) {
    begun = v + 1;
    const bool dark = std::count(arguments.low_light.begin(), arguments.low_light.end(),
                                 static_cast<int>(v) + 1) > 0;
    system.begin_sequence();  // which numbers them as here
    feed(*recordings[v], dark, session, visits[v]);
  }
}

// Poses given in a world of their own (a map begun anew and not yet joined) say nothing about the
// place in the first map, so they do not count as localized.
bool is_localized(const TrackedFrame& frame, const Visit& visit) {
  const bool begins = frame.component == kNoId && visit.first;
  return frame.state == TrackingState::kTracking && (frame.component == 0 || begins);
}

void note(const TrackedFrame& frame, Visit& visit) {
  ++visit.tracked;
  if (!is_localized(frame, visit)) return;
  ++visit.localized;
  if (!visit.first_pose) visit.first_pose = frame.stamp;
  visit.file.append({frame.stamp, frame.world_from_camera});
}

/// What came of a visit.
struct VisitResult {
  Trajectory poses;  ///< in the first map's world, as given at the time
  std::optional<TruthReport> truth;
};

// The poses were not kept while the recordings were fed, which may go on for days.
std::vector<VisitResult> results_of(const System* system, const std::deque<Visit>& visits) {
  std::vector<VisitResult> results(visits.size());
  if (system == nullptr) return results;
  std::size_t v = 0;
  std::size_t seen = 0;
  system->frames().for_each([&](const TrackedFrame& frame) {
    for (; v < visits.size() && seen == visits[v].tracked; ++v) seen = 0;
    if (v == visits.size()) return;  // an error came between the log and the count
    ++seen;
    if (!is_localized(frame, visits[v])) return;
    results[v].poses.push_back({frame.stamp, frame.world_from_camera});
  });
  for (v = 0; v < visits.size(); ++v) {
    results[v].truth = compare_with_truth(visits[v].recording, results[v].poses);
  }
  return results;
}

std::size_t localized(const std::deque<Visit>& visits) {
  std::size_t sum = 0;
  for (const Visit& visit : visits) sum += visit.localized;
  return sum;
}

std::size_t skipped(const Visit& visit) {
  return visit.recording.skipped().size() + visit.failed.size();
}

Json row_of(const Visit& visit, const VisitResult& result, const MapSize& size, bool interrupted) {
  Json row = {{"sequence", visit.recording.name()}, {"frames", visit.frames},
              {"skipped_frames", skipped(visit)},   {"localized", visit.localized},
              {"keyframes", size.keyframes},        {"points", size.points}};
  row["interrupted"] = interrupted;
  row["seconds_to_first_pose"] =
      visit.first_pose ? Json(*visit.first_pose - visit.first_stamp) : Json(nullptr);
  row["ate"] = truth_json(result.truth);
  row.update(recording_json(visit.recording));
  return row;
}

OpenlorisResult openloris_result(const LifelongArguments& arguments,
                                 const std::vector<VisitResult>& results) {
  OpenlorisResult result;
  result.scene = arguments.scene;
  result.frame = arguments.frame;
  for (std::size_t v = 0; v < results.size(); ++v) {
    OpenlorisSequence sequence;
    sequence.number = static_cast<int>(v) + 1;
    sequence.poses = results[v].poses;
    result.sequences.push_back(std::move(sequence));
  }
  return result;
}

MapSize size_after(std::size_t visit, std::size_t visits, const Session& session) {
  if (visit + 1 == visits && session.has_whole_map()) {  // whether or not an error ended it
    const Map& map = session.system()->map();
    return {map.keyframe_count(), map.point_count()};
  }
  const std::map<int, MapSize>& sizes = session.statistics().map_sizes();
  const auto found = sizes.find(static_cast<int>(visit));
  return found == sizes.end() ? MapSize{} : found->second;
}

void write_results(OutputSteps& steps, const LifelongArguments& arguments, Session& session,
                   std::deque<Visit>& visits, const std::vector<VisitResult>& results) {
  ResultFolder& folder = *session.folder();
  if (!steps.run([&] { folder.begin(); })) return;
  for (Visit& visit : visits) steps.run([&] { visit.file.finish(); });
  steps.run([&] {
    write_openloris_result(folder.file(fmt::format("dxslam_{}.txt", arguments.scene)),
                           openloris_result(arguments, results));
  });
  steps.run([&] {
    Json table = Json::array();
    for (std::size_t v = 0; v < visits.size(); ++v) {
      const bool last = v + 1 == visits.size();
      table.push_back(row_of(visits[v], results[v], size_after(v, visits.size(), session),
                             last && stop_requested()));
    }
    write_file_atomically(folder.file("lifelong.json"), to_json_text(table));
  });
}

void print_outcome(const std::deque<Visit>& visits, const std::vector<VisitResult>& results,
                   const Session& session) {
  for (std::size_t v = 0; v < visits.size(); ++v) {
    const Visit& visit = visits[v];
    const MapSize size = size_after(v, visits.size(), session);
    print("{:>3}  {:<24} {:>6} of {:>6} frames localized, {:>5} keyframes, {:>7} points\n", v + 1,
          visit.recording.name(), visit.localized, visit.frames, size.keyframes, size.points);
    if (results[v].truth) print_truth(*results[v].truth, visit.recording.camera());
    print_skipped(all_skipped(visit.recording, visit.failed));
    if (visit.localized == 0 && !visit.first) {
      warn("{}: no frame was localized, for nothing of the first map was recognised",
           visit.recording.name());
    }
  }
}

// Whatever went wrong before: what can be saved is saved.
int end(const LifelongArguments& arguments, Session& session, std::deque<Visit>& visits) {
  session.tell_reader_failures();
  OutputSteps steps;
  steps.run([&] { session.rethrow_error(); });
  session.save_map(steps);
  std::vector<VisitResult> results(visits.size());
  steps.run([&] { results = results_of(session.system(), visits); });
  write_results(steps, arguments, session, visits, results);
  session.all_is_saved();
  print_outcome(visits, results, session);
  std::size_t frames = 0;
  for (const Visit& visit : visits) frames += visit.frames;
  const int code = judge_tracking(localized(visits), frames, session.why_no_pose());
  steps.tell_place(session.folder()->path());
  session.tell_map();
  return session.end(steps, stop_requested() ? kInterrupted : code);
}

int run(const LifelongArguments& arguments) {
  check_name("--scene", arguments.scene);
  check_name("--frame", arguments.frame);
  Session session(arguments.settings);
  const Recordings recordings = open_all(arguments);
  session.claim_targets();
  std::size_t planned = 0;
  for (const auto& recording : recordings) {
    planned += recording->planned().value_or(0);
  }
  Progress progress("frames", planned);
  std::size_t done = 0;
  std::deque<Visit> visits;  // which stay where they are
  for (const auto& recording : recordings) {
    visits.emplace_back(*recording, session.folder(), visits.size() + 1);
  }
  std::size_t begun = 0;
  Visit* visit = nullptr;  // that the messages are of
  const auto system = session.start(recordings.front()->camera(), [&](const Message& message) {
    if (const auto* recording = std::get_if<RecordingBegun>(&message.event)) {
      visit = &visits.at(static_cast<std::size_t>(recording->number));
    }
    const auto* tracked = std::get_if<FrameTracked>(&message.event);
    if (tracked == nullptr) return;
    note(tracked->frame, *visit);
    const bool tracking = tracked->frame.state == TrackingState::kTracking;
    progress.update(++done, tracking ? "tracking" : "lost");
  });
  for (const auto& recording : recordings) print_recording(*recording);
  session.run([&] { feed_all(arguments, recordings, session, visits, begun); });
  while (visits.size() > begun) visits.pop_back();
  progress.finish();
  return end(arguments, session, visits);
}

}  // namespace

void add_lifelong_command(CLI::App& app) {
  auto arguments = std::make_shared<LifelongArguments>();
  RunSettings& settings = arguments->settings;
  CLI::App* command = app.add_subcommand(
      "lifelong", "feed recordings of one place one after another, as if day by day");
  command->add_option("SEQUENCE", arguments->sequences, recording_help() + "; several, in order")
      ->required();
  command->add_option("--out", settings.out, "folder for the results")->required();
  add_run_options(*command, settings);
  command->add_option("--scene", arguments->scene, "name of the scene in the result")
      ->capture_default_str();
  command->add_option("--frame", arguments->frame, "name of the camera in the result")
      ->capture_default_str();
  command
      ->add_option("--low-light-in", arguments->low_light,
                   "darken the sequences of these numbers (from 1; low-light model)")
      ->check(whole_number(1));
  command->callback([arguments] {
    if (const int code = run(*arguments); code != kSuccess) throw CLI::RuntimeError(code);
  });
}

}  // namespace dxslam::apps
