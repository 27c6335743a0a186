// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "apps/commands.h"
#include "apps/console.h"
#include "io/calibration/calibration.h"
#include "io/formats/options_yaml.h"
#include "slam/system_options.h"

namespace dxslam::apps {
namespace {

void dump(const std::string& camera) {
  if (!camera.empty()) {
    print_text(camera_preset_text(camera));
    return;
  }
  print_text(fmt::format(
      "# The default configuration of dxslam {}. Give a file with the lines to change to\n"
      "# dxslam run --config; what it leaves out keeps its default.\n{}",
      DXSLAM_VERSION, dump_options_yaml(SystemOptions{})));
}

}  // namespace

void add_config_command(CLI::App& app) {
  CLI::App* config = app.add_subcommand("config", "show configurations and camera files");
  config->require_subcommand(1);
  CLI::App* command = config->add_subcommand(
      "dump", "print the default configuration, or a camera preset, as YAML");
  const auto camera = std::make_shared<std::string>();
  command
      ->add_option("--camera", *camera,
                   fmt::format("camera preset: {}", fmt::join(camera_preset_names(), ", ")))
      ->option_text("NAME");
  command->callback([camera] { dump(*camera); });
}

}  // namespace dxslam::apps
