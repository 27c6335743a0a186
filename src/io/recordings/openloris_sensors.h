// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <vector>

#include "core/se3.h"

namespace dxslam {

/// Names of the frames on the robots of OpenLORIS-Scene whose poses are known here, base_link
/// first.
const std::vector<std::string>& openloris_frames();

/// base_from_sensor as published with OpenLORIS-Scene, which used two robots: one in the office,
/// corridor, home and cafe, another in the market. `frame` is one of openloris_frames(); throws
/// InputError for any other.
SE3 openloris_base_from_sensor(bool market, const std::string& frame);

}  // namespace dxslam
