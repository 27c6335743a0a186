// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/commands.h"
#include "apps/console.h"
#include "apps/map_io.h"
#include "apps/process.h"
#include "apps/progress.h"
#include "apps/stoppable_sequence.h"
#include "apps/system_setup.h"
#include "apps/usage.h"
#include "evaluation/openloris_result.h"
#include "features/extractor_factory.h"
#include "io/formats/trajectory_file.h"
#include "io/primitives/atomic_file.h"
#include "io/primitives/json_text.h"
#include "io/recordings/sequence_reader.h"
#include "slam/system.h"
#include "synthetic/low_light.h"

namespace dxslam::apps {
namespace {

namespace fs = std::filesystem;

struct LifelongSettings {
  std::vector<std::string> sequences;
  SequenceOptions reader;
  std::string config;
  std::string features;
  std::string out;
  std::string map_in;
  std::string map_out;
  std::string mode;
  std::string scene;
  std::string frame = "d400_color";
  std::size_t stride = 1;
  std::vector<int> low_light;  ///< numbers of the sequences that are darkened
  bool deterministic = false;
};

/// What is known of one sequence when all have run.
struct Visit {
  std::string name;
  std::size_t frames = 0;
  Trajectory online;  ///< poses in the map's world, as given at the time
  double first_stamp = 0.0;
};

std::vector<std::unique_ptr<RgbdSequence>> open_all(const LifelongSettings& settings) {
  std::vector<std::unique_ptr<RgbdSequence>> all;
  for (const std::string& folder : settings.sequences) {
    all.push_back(stoppable(open_sequence(folder, settings.reader)));
    const Camera& first = all.front()->camera();
    const Camera& camera = all.back()->camera();
    if (camera.width != first.width || camera.height != first.height || camera.fx != first.fx ||
        camera.fy != first.fy || camera.cx != first.cx || camera.cy != first.cy) {
      throw InputError(fmt::format("{}: has another camera than {}, expected one camera for all",
                                   folder, settings.sequences.front()));
    }
  }
  return all;
}

void feed(const LifelongSettings& settings, RgbdSequence& sequence, bool dark, System& system,
          Visit& visit) {
  const LowLight low_light(LowLight::kDefaultGain);
  system.begin_sequence();
  for (std::size_t i = 0; i < sequence.size(); i += settings.stride) {
    std::optional<RgbdImage> image = sequence.read(i);
    if (stop_requested()) return;
    if (!image) continue;
    if (dark) image->color = low_light.apply(image->color, image->index);
    if (visit.frames++ == 0) visit.first_stamp = image->stamp;
    system.process(*image);
  }
}

// Poses given in a world of their own (a map begun anew and not yet joined) say nothing about the
// place in the first map, so they do not count as localized.
void collect_online_poses(const System& system, std::vector<Visit>& visits) {
  std::size_t v = 0;
  std::size_t left = visits.front().frames;  // of visit v
  system.frames().for_each([&](const TrackedFrame& frame) {
    while (left == 0) left = visits[++v].frames;
    --left;
    const bool begins = frame.component == kNoId && v == 0;
    if (frame.state != TrackingState::kTracking || (frame.component != 0 && !begins)) return;
    visits[v].online.push_back({frame.stamp, frame.world_from_camera});
  });
}

void write_lifelong(const LifelongSettings& settings, const System& system,
                    const std::vector<Visit>& visits) {
  OpenlorisResult result;
  result.scene = settings.scene;
  result.frame = settings.frame;
  nlohmann::ordered_json table = nlohmann::ordered_json::array();
  for (std::size_t v = 0; v < visits.size(); ++v) {
    const Visit& visit = visits[v];
    OpenlorisSequence sequence;
    sequence.number = static_cast<int>(v) + 1;
    sequence.poses = visit.online;
    result.sequences.push_back(sequence);
    const MapSize size = v < system.map_sizes().size() ? system.map_sizes()[v] : MapSize{};
    nlohmann::ordered_json row = {{"sequence", visit.name},
                                  {"frames", visit.frames},
                                  {"localized", visit.online.size()},
                                  {"keyframes", size.keyframes},
                                  {"points", size.points}};
    row["seconds_to_first_pose"] =
        visit.online.empty()
            ? nlohmann::ordered_json(nullptr)
            : nlohmann::ordered_json(visit.online.front().stamp - visit.first_stamp);
    table.push_back(row);
    write_trajectory(fs::path(settings.out) / fmt::format("online_{}.txt", v + 1), visit.online);
    print("{:>3}  {:<24} {:>6} of {:>6} frames localized, {:>5} keyframes, {:>7} points\n", v + 1,
          visit.name, visit.online.size(), visit.frames, size.keyframes, size.points);
  }
  write_openloris_result(fs::path(settings.out) / fmt::format("dxslam_{}.txt", settings.scene),
                         result);
  write_file_atomically(fs::path(settings.out) / "lifelong.json", to_json_text(table));
}

int run(const LifelongSettings& settings) {
  const SystemOptions options = load_system_options(
      {settings.config, settings.features, settings.mode, settings.deterministic});
  const auto sequences = open_all(settings);
  make_folder(settings.out);
  std::size_t planned = 0;
  for (const auto& s : sequences) planned += (s->size() + settings.stride - 1) / settings.stride;
  Progress progress("frames", planned);
  std::size_t done = 0;
  System system(sequences.front()->camera(), make_extractor(options.features, options.extractor),
                options, [&](const TrackedFrame& frame) {
                  const bool tracking = frame.state == TrackingState::kTracking;
                  progress.update(++done, tracking ? "tracking" : "lost");
                });
  const MapHeader header = map_header(sequences.front()->camera(), system.extractor());
  std::vector<std::string> thumbnails;
  if (!settings.map_in.empty()) {
    thumbnails = hand_over(load_map(settings.map_in), system, settings.map_in, header,
                           options.mode == "slam");
  }
  std::optional<Unsaved> unsaved(std::in_place);
  std::vector<Visit> visits;
  for (std::size_t v = 0; v < sequences.size() && !stop_requested(); ++v) {
    visits.push_back({sequences[v]->name(), 0, {}, 0.0});
    const bool dark = std::count(settings.low_light.begin(), settings.low_light.end(),
                                 static_cast<int>(v) + 1) > 0;
    feed(settings, *sequences[v], dark, system, visits.back());
  }
  system.finish([] { return !stop_requested(); });
  progress.finish();
  if (!settings.map_out.empty()) {
    save_system_map(settings.map_out, header, system.map(), system.backend().closed_loops(),
                    thumbnails);
  }
  collect_online_poses(system, visits);
  write_lifelong(settings, system, visits);
  unsaved.reset();
  print("results in {}\n", settings.out);
  return kSuccess;
}

}  // namespace

void add_lifelong_command(CLI::App& app) {
  auto settings = std::make_shared<LifelongSettings>();
  settings->scene = "scene";
  CLI::App* command = app.add_subcommand(
      "lifelong", "Feed recordings of one place one after another, as if day by day");
  command->add_option("SEQUENCE", settings->sequences, "Folders, in order")->required();
  command->add_option("--out", settings->out, "Folder for the results")->required();
  command
      ->add_option("--format", settings->reader.format, "auto, tum, 7scenes, openloris or folder")
      ->capture_default_str();
  command->add_option("--calibration", settings->reader.calibration,
                      "Camera preset or YAML file (default: by format)");
  command->add_option("--config", settings->config, "YAML file; see `dxslam config dump`");
  command->add_option("--features", settings->features, "Extractor name or model manifest");
  command->add_option("--mode", settings->mode, "slam, or localization in the map of --map-in");
  command->add_option("--map-in", settings->map_in, "Go on with this map");
  command->add_option("--map-out", settings->map_out, "Save the map here");
  command->add_option("--scene", settings->scene, "Name of the scene in the result")
      ->capture_default_str();
  command->add_option("--frame", settings->frame, "Name of the camera in the result")
      ->capture_default_str();
  command->add_option("--stride", settings->stride, "Use every n-th frame")->check(whole_number(1));
  command
      ->add_option("--low-light-in", settings->low_light,
                   "Darken the sequences of these numbers (from 1; low-light model)")
      ->check(whole_number(1));
  command->add_flag("--deterministic", settings->deterministic,
                    "One thread, exact arithmetic: the same result every time");
  command->callback([settings] {
    if (const int code = run(*settings); code != kSuccess) throw CLI::RuntimeError(code);
  });
}

}  // namespace dxslam::apps
