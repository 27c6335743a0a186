// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/system_setup.h"

#include "features/extractor_factory.h"
#include "io/formats/options_yaml.h"

namespace dxslam::apps {

SystemOptions load_system_options(const SystemArguments& arguments) {
  SystemOptions options;
  if (!arguments.config.empty()) options = load_options(arguments.config, options);
  if (!arguments.features.empty()) options.features = arguments.features;
  if (options.features == "auto") options.features = default_extractor();
  if (!arguments.mode.empty()) options.mode = arguments.mode;
  options.deterministic = options.deterministic || arguments.deterministic;
  options.extractor.deterministic = options.extractor.deterministic || options.deterministic;
  validate_system_options(options);
  return options;
}

}  // namespace dxslam::apps
