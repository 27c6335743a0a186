// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <rmw/qos_profiles.h>
#include <rmw/types.h>

#include <cstddef>

namespace dxslam::ros2 {

/// How messages of a topic are kept and sent. The two ends must fit: who asks for more than is
/// offered (reliable from best effort, transient local from volatile) gets nothing, and a warning.
using Qos = rmw_qos_profile_t;

/// Best effort, the newest few: for small messages of which the next is as good.
inline Qos sensor_data() { return rmw_qos_profile_sensor_data; }

/// Reliable, the newest `depth`: the usual.
inline Qos reliable(std::size_t depth = 10) {
  Qos qos = rmw_qos_profile_default;
  qos.depth = depth;
  return qos;
}

/// For reading images: reliable from publishers that are, best effort from the first on that is not
/// (only a subscription can be so). Images are cut into pieces, and one lost piece loses
/// the image: read best effort, most do not arrive (docs/ros.md).
inline Qos camera_data(std::size_t depth = 5) {
  Qos qos = reliable(depth);
  qos.reliability = RMW_QOS_POLICY_RELIABILITY_BEST_AVAILABLE;
  return qos;
}

/// Reliable, and who comes late still gets the newest `depth`: maps, states, static transforms.
inline Qos latched(std::size_t depth = 1) {
  Qos qos = reliable(depth);
  qos.durability = RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL;
  return qos;
}

}  // namespace dxslam::ros2
