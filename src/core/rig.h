// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "core/error.h"

namespace dxslam {

/// Place of a camera in a Rig.
using CameraId = std::uint32_t;

/// The cameras that the frames of a map were taken with, by rising id. Cameras are never removed or
/// changed. A value; as thread-safe as std::vector.
class Rig {
 public:
  Rig() = default;
  explicit Rig(const Camera& camera) { add(camera); }

  /// The id of the camera, which is added where none sees as it does (Camera::sees_as).
  CameraId add(const Camera& camera) {
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      if (cameras_[i].sees_as(camera)) return static_cast<CameraId>(i);
    }
    cameras_.push_back(camera);
    return static_cast<CameraId>(cameras_.size() - 1);
  }

  bool has(CameraId id) const { return id < cameras_.size(); }
  /// Throws ContractError for an id that was not given.
  const Camera& operator[](CameraId id) const {
    require(has(id), "a camera must be in the rig");
    return cameras_[id];
  }
  std::size_t size() const { return cameras_.size(); }
  const std::vector<Camera>& cameras() const { return cameras_; }

 private:
  std::vector<Camera> cameras_;
};

}  // namespace dxslam
