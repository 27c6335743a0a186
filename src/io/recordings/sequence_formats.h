// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <filesystem>
#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "io/recordings/depth_registration.h"
#include "io/recordings/listed_sequence.h"
#include "io/recordings/sequence_reader.h"

namespace dxslam {

// One function per format, each in a file of its own; `folder` exists; that of a bag may be a file.
// All throw InputError.
SequenceListing list_tum(const std::string& folder, const SequenceOptions& options);
SequenceListing list_openloris(const std::string& folder, const SequenceOptions& options);
SequenceListing list_seven_scenes(const std::string& folder, const SequenceOptions& options);
SequenceListing list_folder(const std::string& folder, const SequenceOptions& options);
SequenceListing list_kitti(const std::string& folder, const SequenceOptions& options);
SequenceListing list_image_folder(const std::string& folder, const SequenceOptions& options);
SequenceListing list_bag(const std::string& path, const SequenceOptions& options);

/// What open_sequence() makes its sequence of: lists, calibration and trajectories, but no image.
SequenceListing list_sequence(const std::string& path, const SequenceOptions& options);

/// Whether `folder` holds frames named as those of 7-Scenes.
bool has_seven_scenes_frames(const std::string& folder);

// What the readers share.

/// Images a second where nothing says when they were taken.
inline constexpr double kDefaultFps = 10.0;

/// "folder/name".
std::string in_folder(const std::string& folder, const std::string& name);
/// Last part of the path, also of one that ends with '/'.
std::string folder_name(const std::string& folder);
/// The calibration the user gave, or the folder's own calibration.yaml or camera.yaml; returns
/// whether there was one, and then sets the camera, its source and, where the depth camera is
/// given, the registration.
bool use_explicit_calibration(const std::string& folder, const SequenceOptions& options,
                              SequenceListing& listing);
/// Depth images are those of another camera: they are registered while they are read. To be called
/// once the listing's own camera is known.
void use_depth_camera(const DepthCamera& depth_camera, SequenceListing& listing);
/// Frames from two lists of "stamp file", each colour image with the depth image nearest in time,
/// or from the association file of the options. Names may have blanks in them. A line that repeats
/// another is skipped, and so is one that cannot be read or is not in order, unless more than one
/// line in ten is such. Fills frames, skipped and notes.
void associate_lists(const std::string& folder, const std::string& color_list,
                     const std::string& depth_list, const SequenceOptions& options,
                     SequenceListing& listing);
/// Sets the true trajectory to what `read` returns. Where that throws InputError the recording has
/// none, and the reason becomes a note: the truth is no part of what a recording needs.
void take_truth(SequenceListing& listing, const std::function<Trajectory()>& read);
/// The images of a folder (list_image_files); its notes go to those of the listing. Throws
/// InputError if there is none.
std::vector<std::filesystem::path> list_images(const std::string& folder, SequenceListing& listing);
/// Size of the first readable one in probe_order(); throws InputError if none is.
cv::Size image_size(const std::vector<std::filesystem::path>& images);
/// The camera of SequenceOptions::needs_calibration = false.
Camera made_up_camera(cv::Size size);

}  // namespace dxslam
