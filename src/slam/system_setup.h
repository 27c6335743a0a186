// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <vector>

#include "features/extractor.h"
#include "slam/system_options.h"

namespace dxslam {

/// Names the features where they are `auto`, has the extractor be deterministic where the system
/// is, and checks all. Throws InputError for what cannot be used.
void settle_options(SystemOptions& options);

/// What the user should know about the features: of their choice, of the extractor itself, and what
/// cannot be done with them. `in_stored_map`: a map is gone on with.
std::vector<std::string> feature_notes(const SystemOptions& options,
                                       const FeatureExtractor& extractor, bool in_stored_map);

}  // namespace dxslam
