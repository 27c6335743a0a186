// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "features/extractor.h"
#include "features/extractor_options.h"

namespace dxslam {

/// Makes an extractor of
///   - `orb`, or `opencv_orb` without the spreading;
///   - the name of a model: NAME stands for models/NAME/manifest.yaml or manifests/NAME.yaml in
///     data_directory(); `hfnet` is the one that is shipped;
///   - a path of a manifest, ending in .yaml;
///   - any of these followed by `+brief` (upright) or `+rbrief` (turned): its keypoints with BRIEF
///     descriptors.
/// Throws InputError if the name is unknown, an option is out of range, or the model is unusable.
std::unique_ptr<FeatureExtractor> make_extractor(const std::string& name_or_manifest,
                                                 const ExtractorOptions& options = {});

/// Throws InputError for a name that make_extractor() does not know; paths are not looked at.
void require_known_extractor(const std::string& name_or_manifest);

/// What is taken where the user names no features.
struct ExtractorChoice {
  std::string name;
  std::string note;  ///< a sentence for the user why it is not the network; "" if it is
};

/// `hfnet` where its model is there, else `orb`. Throws InputError if $DXSLAM_DATA is set, but does
/// not hold the model.
ExtractorChoice choose_extractor();

/// Names that make_extractor() knows without a path, `orb` first; the model files of some may be
/// missing.
std::vector<std::string> known_extractors();

/// Those of them whose model files are there.
std::vector<std::string> available_extractors();

}  // namespace dxslam
