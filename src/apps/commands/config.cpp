// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "apps/commands.h"
#include "apps/console.h"
#include "apps/usage.h"
#include "io/calibration/calibration.h"
#include "io/formats/options_yaml.h"
#include "slam/system_options.h"

namespace dxslam::apps {
namespace {

struct DumpArguments {
  std::string camera;
  bool all = false;
};

void dump(const DumpArguments& arguments) {
  if (!arguments.camera.empty()) {
    print_text(camera_preset_text(arguments.camera));
    return;
  }
  OptionsYamlWriter writer(arguments.all ? OptionsFor::kExperts : OptionsFor::kUsers);
  const SystemOptions defaults;
  SystemOptions::describe(defaults, writer);
  print_text(fmt::format(
      "# The default configuration of dxslam {}. Give a file with the lines to change to\n"
      "# dxslam run --config; what it leaves out keeps its default.\n{}{}",
      DXSLAM_VERSION,
      arguments.all ? ""
                    : fmt::format("# {} more options, for experts: dxslam config dump --all\n",
                                  writer.left_out()),
      writer.text()));
}

}  // namespace

void add_config_command(CLI::App& app) {
  CLI::App* config = app.add_subcommand("config", "show configurations and camera files");
  config->require_subcommand(1);
  CLI::App* command = config->add_subcommand(
      "dump", "print the default configuration, or a camera preset, as YAML");
  const auto arguments = std::make_shared<DumpArguments>();
  command->add_flag("--all", arguments->all, "the options for experts as well");
  command
      ->add_option("--camera", arguments->camera,
                   fmt::format("camera preset: {}", fmt::join(camera_preset_names(), ", ")))
      ->check(one_of(camera_preset_names()))
      ->option_text("NAME");
  command->callback([arguments, command] {
    refuse_unused(*command, "--all", arguments->camera.empty(), "without --camera");
    dump(*arguments);
  });
}

}  // namespace dxslam::apps
