// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <deque>
#include <mutex>
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
  Visit(const RgbdSequence& fed, ResultFolder* folder, std::size_t number)
      : recording(fed), first(number == 1), file(folder, fmt::format("online_{}.txt", number)) {}

  const RgbdSequence& recording;
  const bool first;
  std::size_t frames = 0;
  double first_stamp = 0.0;
  Trajectory online;  ///< poses in the first map's world, as given at the time
  OnlineTrajectory file;
};

// Which visit the frames are of that are not tracked yet. Two threads.
class Underway {
 public:
  void push(Visit& visit) {
    const std::lock_guard lock(mutex_);
    visits_.push_back(&visit);
  }
  Visit& pop() {
    const std::lock_guard lock(mutex_);
    Visit& visit = *visits_.front();
    visits_.pop_front();
    return visit;
  }

 private:
  std::mutex mutex_;
  std::deque<Visit*> visits_;
};

using Recordings = std::vector<std::unique_ptr<RgbdSequence>>;

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
    all.push_back(stoppable(open_recording(folder, arguments.settings.reader)));
    require_depth(*all.back());
    const Camera& first = all.front()->camera();
    const Camera& camera = all.back()->camera();
    if (camera.width != first.width || camera.height != first.height || camera.fx != first.fx ||
        camera.fy != first.fy || camera.cx != first.cx || camera.cy != first.cy) {
      throw InputError(fmt::format("{}: has another camera than {}, expected one camera for all",
                                   folder, arguments.sequences.front()));
    }
  }
  return all;
}

void feed(RgbdSequence& recording, std::size_t stride, bool dark, Session& session, Visit& visit,
          Underway& underway) {
  const LowLight low_light(LowLight::kDefaultGain);
  session.system()->begin_sequence();
  for (std::size_t i = 0; i < recording.size(); i += stride) {
    std::optional<RgbdImage> image = recording.read(i);
    if (stop_requested()) return;
    if (!image) continue;
    if (dark) image->color = low_light.apply(image->color, image->index);
    if (visit.frames++ == 0) visit.first_stamp = image->stamp;
    underway.push(visit);
    session.process(*image, false);
  }
}

void feed_all(const LifelongArguments& arguments, const Recordings& recordings, Session& session,
              std::deque<Visit>& visits, Underway& underway) {
  for (std::size_t v = 0; v < recordings.size() && !stop_requested(); ++v) {
    visits.emplace_back(*recordings[v], session.folder(), v + 1);
    const bool dark = std::count(arguments.low_light.begin(), arguments.low_light.end(),
                                 static_cast<int>(v) + 1) > 0;
    feed(*recordings[v], arguments.settings.stride, dark, session, visits.back(), underway);
  }
}

// Poses given in a world of their own (a map begun anew and not yet joined) say nothing about the
// place in the first map, so they do not count as localized.
void note(const TrackedFrame& frame, Visit& visit) {
  const bool begins = frame.component == kNoId && visit.first;
  if (frame.state != TrackingState::kTracking || (frame.component != 0 && !begins)) return;
  visit.online.push_back({frame.stamp, frame.world_from_camera});
  visit.file.append(visit.online.back());
}

std::size_t localized(const std::deque<Visit>& visits) {
  std::size_t sum = 0;
  for (const Visit& visit : visits) sum += visit.online.size();
  return sum;
}

Json row_of(const Visit& visit, const MapSize& size) {
  Json row = {{"sequence", visit.recording.name()},
              {"frames", visit.frames},
              {"localized", visit.online.size()},
              {"keyframes", size.keyframes},
              {"points", size.points}};
  row["seconds_to_first_pose"] =
      visit.online.empty() ? Json(nullptr) : Json(visit.online.front().stamp - visit.first_stamp);
  row["ate"] = truth_json(compare_with_truth(visit.recording, visit.online));
  row.update(recording_json(visit.recording));
  return row;
}

OpenlorisResult result_of(const LifelongArguments& arguments, const std::deque<Visit>& visits) {
  OpenlorisResult result;
  result.scene = arguments.scene;
  result.frame = arguments.frame;
  for (std::size_t v = 0; v < visits.size(); ++v) {
    OpenlorisSequence sequence;
    sequence.number = static_cast<int>(v) + 1;
    sequence.poses = visits[v].online;
    result.sequences.push_back(std::move(sequence));
  }
  return result;
}

void write_results(OutputSteps& steps, const LifelongArguments& arguments, Session& session,
                   std::deque<Visit>& visits) {
  ResultFolder& folder = *session.folder();
  if (!steps.run([&] { folder.begin(); })) return;
  for (Visit& visit : visits) steps.run([&] { visit.file.finish(); });
  steps.run([&] {
    write_openloris_result(folder.file(fmt::format("dxslam_{}.txt", arguments.scene)),
                           result_of(arguments, visits));
  });
  steps.run([&] {
    Json table = Json::array();
    for (std::size_t v = 0; v < visits.size(); ++v) {
      const auto& sizes = session.system()->map_sizes();
      table.push_back(row_of(visits[v], v < sizes.size() ? sizes[v] : MapSize{}));
    }
    write_file_atomically(folder.file("lifelong.json"), to_json_text(table));
  });
  if (steps.failures().empty()) folder.finish();
}

void print_outcome(const std::deque<Visit>& visits, const System* system) {
  for (std::size_t v = 0; v < visits.size(); ++v) {
    const Visit& visit = visits[v];
    const MapSize size = v < system->map_sizes().size() ? system->map_sizes()[v] : MapSize{};
    print("{:>3}  {:<24} {:>6} of {:>6} frames localized, {:>5} keyframes, {:>7} points\n", v + 1,
          visit.recording.name(), visit.online.size(), visit.frames, size.keyframes, size.points);
    if (const auto truth = compare_with_truth(visit.recording, visit.online)) {
      print_truth(*truth, visit.recording.camera());
    }
  }
}

int end(const LifelongArguments& arguments, Session& session, std::deque<Visit>& visits) {
  OutputSteps steps;
  session.save_map(steps);
  write_results(steps, arguments, session, visits);
  session.all_is_saved();
  print_outcome(visits, session.system());
  std::size_t frames = 0;
  for (const Visit& visit : visits) frames += visit.frames;
  const int code = judge_tracking(localized(visits), frames, session.why_no_pose());
  print("results in {}\n", session.folder()->path());
  return steps.report(stop_requested() ? kInterrupted : code);
}

int run(const LifelongArguments& arguments) {
  check_name("--scene", arguments.scene);
  check_name("--frame", arguments.frame);
  Session session(arguments.settings);
  const Recordings recordings = open_all(arguments);
  session.claim_targets();
  std::size_t planned = 0;
  for (const auto& recording : recordings) {
    planned += (recording->size() + arguments.settings.stride - 1) / arguments.settings.stride;
  }
  Progress progress("frames", planned);
  std::size_t done = 0;
  std::deque<Visit> visits;  // which stay where they are
  Underway underway;
  const auto system = session.start(recordings.front()->camera(), [&](const TrackedFrame& frame) {
    Visit& visit = underway.pop();
    note(frame, visit);
    const bool tracking = frame.state == TrackingState::kTracking;
    progress.update(++done, tracking ? "tracking" : "lost");
  });
  for (const auto& recording : recordings) print_recording(*recording);
  if (system) feed_all(arguments, recordings, session, visits, underway);
  session.finish();
  progress.finish();
  return end(arguments, session, visits);
}

}  // namespace

void add_lifelong_command(CLI::App& app) {
  auto arguments = std::make_shared<LifelongArguments>();
  RunSettings& settings = arguments->settings;
  CLI::App* command = app.add_subcommand(
      "lifelong", "Feed recordings of one place one after another, as if day by day");
  command->add_option("SEQUENCE", arguments->sequences, "Folders, in order")->required();
  command->add_option("--out", settings.out, "Folder for the results")->required();
  add_run_options(*command, settings);
  command->add_option("--scene", arguments->scene, "Name of the scene in the result")
      ->capture_default_str();
  command->add_option("--frame", arguments->frame, "Name of the camera in the result")
      ->capture_default_str();
  command
      ->add_option("--low-light-in", arguments->low_light,
                   "Darken the sequences of these numbers (from 1; low-light model)")
      ->check(whole_number(1));
  command->callback([arguments] {
    if (const int code = run(*arguments); code != kSuccess) throw CLI::RuntimeError(code);
  });
}

}  // namespace dxslam::apps
