// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <string>

#include "features/extractor.h"
#include "features/extractor_options.h"
#include "features/network/model_manifest.h"

namespace dxslam {

/// Extractor of a network with dense heads (paper III.B): inference by OpenVINO, then threshold,
/// non-maximum suppression, an evenly spread choice of the best, and bilinear sampling of the
/// descriptor map. Throws InputError if a model file is missing, damaged or does not fit the
/// manifest.
std::unique_ptr<FeatureExtractor> make_network_extractor(const ModelManifest& manifest,
                                                         const ExtractorOptions& options);

}  // namespace dxslam
