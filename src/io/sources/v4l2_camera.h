// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <string>

#include "io/sources/live_camera.h"
#include "io/sources/video_device.h"

namespace dxslam {

/// "v4l2:COLOUR,DEPTH?fps=30": video devices of Linux, of which the second may be missing. Many
/// depth cameras are such, without any library: RealSense gives Z16 and YUYV. `calibration`: as of
/// SequenceOptions; it must be there, as the devices say nothing, and says the sizes to ask for.
/// Throws InputError.
std::unique_ptr<LiveCamera> open_v4l2(const SourceName& name, const std::string& calibration,
                                      const OpenVideoDevice& open = open_video_device);

}  // namespace dxslam
