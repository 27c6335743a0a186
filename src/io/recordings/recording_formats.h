// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <string>

#include "io/recordings/recording_writer.h"

namespace dxslam {

// One function per form of recording_writer.h, each in a file of its own. At `path` is nothing, or
// an empty file or folder.
std::unique_ptr<RecordingWriter> create_mcap_recording(const std::string& path,
                                                       const ImageOrigin& origin);
std::unique_ptr<RecordingWriter> create_tum_recording(const std::string& path,
                                                      const ImageOrigin& origin);

/// Raw CV_16UC1 depth, `factor` units per metre, of CV_32FC1 metres. Sets `exact` to whether
/// reading it gives the same metres again. What is too far for 16 bits becomes 0.
cv::Mat raw_depth(const cv::Mat& metres, double factor, bool& exact);

/// The topic of the calibration, as the text of a camera file, which says more than camera_info.
inline constexpr const char* kCalibrationTopic = "/dxslam/calibration";

}  // namespace dxslam
