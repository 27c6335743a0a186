// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/system_setup.h"

#include "apps/console.h"
#include "io/formats/options_yaml.h"
#include "slam/system_setup.h"

namespace dxslam::apps {

SystemOptions load_system_options(const SystemArguments& arguments) {
  SystemOptions options;
  if (!arguments.config.empty()) options = load_options(arguments.config, options);
  if (!arguments.features.empty()) options.features = arguments.features;
  if (!arguments.mode.empty()) options.mode = arguments.mode;
  options.deterministic = options.deterministic || arguments.deterministic;
  settle_options(options);
  return options;
}

void tell_notes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) warn_text("note: " + note);
}

}  // namespace dxslam::apps
