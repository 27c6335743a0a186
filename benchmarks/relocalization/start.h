// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/frame.h"
#include "features/extractor.h"
#include "map/map.h"

namespace dxslam::benchmark {

/// Saves `map` to `file` and writes, as a table in Markdown, how long the parts of a start take
/// from the file to the first pose of `image` in it: wall time, median and longest of `runs`, each
/// with a network and a system of its own. Throws InputError if the image is not found in the map.
void measure_start(const Map& map, const Camera& camera, const RgbdImage& image,
                   const std::function<std::unique_ptr<FeatureExtractor>()>& make_extractor,
                   const std::string& file, int runs);

}  // namespace dxslam::benchmark
