// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "apps/commands.h"
#include "apps/console.h"
#include "apps/process.h"
#include "apps/progress.h"
#include "apps/usage.h"
#include "core/lens.h"
#include "synthetic/tum_writer.h"

namespace dxslam::apps {
namespace {

struct SynthArguments {
  std::string out;
  SyntheticOptions options;
  std::vector<std::string> factors;
  bool force = false;
  bool png = false;
};

std::string factor_help() {
  std::string text = "NAME or NAME=STRENGTH, may be repeated: ";
  for (const FactorName& factor : factor_names()) {
    if (&factor != &factor_names().front()) text += ", ";
    text += factor.name;
  }
  return text;
}

std::vector<std::string> lens_names() {
  std::vector<std::string> names;
  for (const LensModel* model : lens_models()) names.emplace_back(model->name);
  return names;
}

void run_synth(SynthArguments& arguments) {
  for (const std::string& factor : arguments.factors) {
    set_factor(arguments.options.factors, factor);
  }
  require_usable_folder(arguments.out, arguments.force);
  const SyntheticSequence sequence(arguments.options);
  TumWriterOptions writer;
  writer.overwrite = arguments.force;
  writer.png = arguments.png;
  writer.threads = arguments.options.threads;
  Progress progress("frames", sequence.size());
  writer.progress = [&progress](std::size_t done, std::size_t) {
    progress.update(done, "drawing");
    return !stop_requested();
  };
  const Unsaved unsaved;
  if (!write_tum_sequence(sequence, arguments.out, writer)) return;
  progress.finish();
  print("{}, {:.1f} m, in {}\n", counted(sequence.size(), "frame"), sequence.path_length(),
        arguments.out);
}

}  // namespace

void add_synth_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("synth", "make a recording of a synthetic place (TUM RGB-D format)");
  auto arguments = std::make_shared<SynthArguments>();
  SyntheticOptions& options = arguments->options;
  options.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  command->add_option("OUT", arguments->out, "folder to write to")->required();
  command->add_option("--scene", options.scene, "room, office or corridor (a loop of 208 m)")
      ->check(one_of({"room", "office", "corridor"}))
      ->capture_default_str();
  command->add_option("--frames", options.frames, "most frames; 0: the whole path")
      ->check(range_of<SyntheticOptions>("frames"))
      ->capture_default_str();
  command->add_option("--fps", options.fps, "frames per second")
      ->check(range_of<SyntheticOptions>("fps"))
      ->capture_default_str();
  command->add_option("--seed", options.seed, "place and walk")
      ->check(range_of<SyntheticOptions>("seed"))
      ->capture_default_str();
  command->add_option("--width", options.width, "pixels")
      ->check(range_of<SyntheticOptions>("width"))
      ->capture_default_str();
  command->add_option("--height", options.height, "pixels")
      ->check(range_of<SyntheticOptions>("height"))
      ->capture_default_str();
  command->add_option("--focal-length", options.focal_length, "of the camera, in image widths")
      ->check(range_of<SyntheticOptions>("focal_length"))
      ->capture_default_str();
  command
      ->add_option("--lens", options.lens,
                   fmt::format("{} (default: none)", fmt::join(lens_names(), ", ")))
      ->check(one_of(lens_names()));
  command->add_option("--speed", options.path.speed, "walking speed, m/s; 0: the scene's own")
      ->check(range_of<PathOptions>("speed"))
      ->capture_default_str();
  command->add_option("--camera-height", options.path.height, "metres above the floor")
      ->check(range_of<PathOptions>("height"))
      ->capture_default_str();
  command
      ->add_option("--offset", options.path.sideways,
                   "metres that the path is shifted to the right, -0.4 to 0.4")
      ->check(range_of<PathOptions>("sideways"))
      ->capture_default_str();
  command
      ->add_option("--walk", options.path.walk,
                   "another walk through the same place: other glances, another hand")
      ->check(range_of<PathOptions>("walk"))
      ->capture_default_str();
  command->add_flag("--reverse", options.path.reverse,
                    "walk the path the other way, looking the other way");
  command->add_option("--standstill", options.path.standstill, "seconds at rest before the walk")
      ->check(range_of<PathOptions>("standstill"))
      ->capture_default_str();
  command->add_option("--factor", arguments->factors, factor_help())
      ->check(accepted_by([](const std::string& text) {
        FactorOptions unused;
        set_factor(unused, text);
      }))
      ->allow_extra_args(false);
  command->add_option("--factor-seed", options.factors.seed, "seed of the factors")
      ->check(range_of<FactorOptions>("seed"))
      ->capture_default_str();
  command->add_flag("--png", arguments->png, "colour images without loss instead of JPEG");
  command->add_flag("--force", arguments->force, "replace a recording in OUT");
  command->add_option("--threads", options.threads, "frames drawn at once")
      ->check(range_of<SyntheticOptions>("threads"))
      ->capture_default_str();
  command->callback([arguments, command] {
    refuse_unused(*command, "--factor-seed", !arguments->factors.empty(), "with --factor");
    run_synth(*arguments);
  });
}

}  // namespace dxslam::apps
