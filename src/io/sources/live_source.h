// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "core/image_source.h"
#include "io/sources/live_camera.h"

namespace dxslam {

struct LiveOptions {
  double max_association_s = 0.02;          ///< between colour and depth
  std::chrono::milliseconds silence{5000};  ///< after which a camera counts as gone
};

/// A camera as a source. A thread of its own takes the pictures and pairs colour with depth; next()
/// registers depth where the calibration says that it is of another camera. At most four images
/// wait for next(): older ones are dropped. skipped() keeps the first thousand.
///
/// Waits for the first image, which facts() tell of. Throws InputError, also from next(), one
/// sentence each: nothing comes for `silence`, only one of the two streams comes, their clocks
/// differ, or the camera was unplugged.
std::unique_ptr<ImageSource> make_live_source(const std::string& name,
                                              std::unique_ptr<LiveCamera> camera,
                                              const ImageSelection& selection,
                                              const LiveOptions& options = {});

}  // namespace dxslam
