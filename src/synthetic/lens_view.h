// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "core/camera.h"
#include "synthetic/renderer.h"

namespace dxslam {

/// The lens of a made-up camera: the name of a model, with parameters as real ones have, or "" for
/// none. Throws InputError for an unknown name, with the known ones.
Lens synthetic_lens(const std::string& model);

/// What a camera with a lens sees of a world that is drawn for a pinhole. Immutable.
class LensView {
 public:
  /// `camera` must be prepared.
  explicit LensView(const Camera& camera);

  /// What is to be drawn: a pinhole that sees all that the lens uses.
  const Camera& pinhole() const { return pinhole_; }
  /// The drawing as the lens bends it; black, and without depth, where the lens is not used.
  Rendering bent(const Rendering& drawn) const;

 private:
  Camera pinhole_;
  cv::Mat from_;  // CV_32FC2: the pixel of the pinhole for each of the camera
};

}  // namespace dxslam
