// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <vector>

#include "slam/system_options.h"

namespace dxslam::apps {

/// What commands that run the system have in common; "" leaves what is configured.
struct SystemArguments {
  std::string config;  ///< YAML file
  std::string features;
  std::string mode;
  bool deterministic = false;
};

/// Defaults, then the file, then the command line, with the features named. Throws InputError for
/// what cannot be used.
SystemOptions load_system_options(const SystemArguments& arguments);

/// Says notes (feature_notes) on stderr.
void tell_notes(const std::vector<std::string>& notes);

}  // namespace dxslam::apps
