// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <vector>

#include "features/extractor.h"
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

/// What the user should know about the features: of their choice, of the extractor itself, and what
/// cannot be done with them. `in_stored_map`: a map is gone on with.
std::vector<std::string> feature_notes(const SystemOptions& options,
                                       const FeatureExtractor& extractor, bool in_stored_map);
/// Says them on stderr.
void tell_notes(const std::vector<std::string>& notes);

}  // namespace dxslam::apps
