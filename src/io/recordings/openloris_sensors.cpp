// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/recordings/openloris_sensors.h"

#include <fmt/format.h>

#include "core/error.h"
#include "io/primitives/text_file.h"

namespace dxslam {
namespace {

// x y z qx qy qz qw of a sensor on base_link.
struct Mounting {
  const char* frame;
  double home[7];
  double market[7];
};

constexpr Mounting kMountings[] = {
    {"base_link", {0, 0, 0, 0, 0, 0, 1}, {0, 0, 0, 0, 0, 0, 1}},
    {"d400_color",
     {0.2264836849091656, -0.05114194035652147, 0.916, -0.49676229968284136, 0.4998795887129771,
      -0.49510681269354095, 0.5081504289345848},
     {0.398363566676407, 0.029117046016620643, 1.198511534258444, 0.5508509426177262,
      -0.5167305893488635, 0.44976770953124534, -0.47671977566632984}},
    {"t265_fisheye1",
     {0.23757012582874237, -0.038724749600647444, 0.8950755692783204, -0.49597362846259985,
      0.49833071591566835, -0.4958921122758979, 0.5096740825539088},
     {0.873, 0.026, 0.68, -0.3949830160954541, 0.40598254312596027, -0.5999742016639807,
      0.5649757065669153}},
    {"t265_imu",
     {0.23769333650938815, -0.04942265635384921, 0.894903580913328, 0.5030437335657985,
      0.49268060367606764, 0.5074439466966938, 0.4967025929491916},
     {0.8724694754706082, 0.015314402373202411, 0.6801628399570413, 0.4108974443723151,
      0.39141685497790646, 0.5636503288904802, 0.600211998038325}},
};

}  // namespace

const std::vector<std::string>& openloris_frames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const Mounting& mounting : kMountings) list.emplace_back(mounting.frame);
    return list;
  }();
  return names;
}

SE3 openloris_base_from_sensor(bool market, const std::string& frame) {
  for (const Mounting& mounting : kMountings) {
    if (frame != mounting.frame) continue;
    const double* v = market ? mounting.market : mounting.home;
    return {Eigen::Quaterniond(v[6], v[3], v[4], v[5]), Eigen::Vector3d(v[0], v[1], v[2])};
  }
  throw InputError(
      fmt::format("frame {} is not known on the robots of OpenLORIS-Scene, expected {}",
                  in_quotes(frame), fmt::join(openloris_frames(), ", ")));
}

}  // namespace dxslam
