// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <vector>

#include "core/camera.h"
#include "trial.h"

namespace dxslam::benchmark {

/// One thing that sets a query apart from the map's images.
struct ImageFactor {
  std::string name;
  std::function<Query(const Query&, const Camera&)> apply;
};

/// None; low light; patches over 30 % of the image; only the middle of the image; the image turned
/// by 15, 30 and 45 degrees. Each keeps the depth and the truth in step with the image.
std::vector<ImageFactor> image_factors();

}  // namespace dxslam::benchmark
