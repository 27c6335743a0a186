// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/sequence.h"
#include "io/formats/trajectory_reader.h"

namespace dxslam {

/// How a recording is read.
struct SequenceOptions {
  std::string format = "auto";  ///< auto, or one of sequence_formats()
  /// Text file "stamp colour stamp depth" a line that replaces the search for the nearest stamp,
  /// relative paths as in the lists (TUM, OpenLORIS); empty = none.
  std::string association;
  /// Camera preset or YAML file; empty = calibration.yaml or camera.yaml of the folder, else what
  /// the format or the folder's name says.
  std::string calibration;
  /// Topics of a bag to take the images from; empty = the ones that are likeliest.
  std::string color_topic, depth_topic;
  double max_association_s = 0.02;  ///< largest difference of colour and depth stamps, seconds
  /// all, left or right: which images of a folder in which two cameras take turns, left first
  /// (images), or which camera (kitti; `all` is its left one). Others have one camera.
  std::string eye = "all";
  /// If false, a folder, bag or images without any calibration get a pinhole camera with a focal
  /// length of the image width: for what looks at appearance only.
  bool needs_calibration = true;
};

/// The names of the formats, in the order in which they are listed below.
const std::vector<std::string>& sequence_formats();
/// "auto" and these, for help and messages.
std::string sequence_format_list();
/// What each is known by, for help and messages: "rgb.txt and depth.txt (tum), ...".
std::string known_recordings();

/// Opens a recording. Lists, calibration and trajectories are read and checked at once, a few
/// images are decoded to check size and depth scale, all others are read on demand.
/// A colour image without a depth image near enough in time is left out and recorded in skipped()
/// with the index of the frame behind it.
///
/// Formats:
/// - tum: rgb.txt, depth.txt ("stamp file"), optional groundtruth.txt.
/// - openloris: color.txt, aligned_depth.txt, optional groundtruth.txt (pose of base_link, which is
///   moved to the colour camera), sensors.yaml, trans_matrix.yaml.
/// - 7scenes: frame-NNNNNN.{color.png|color.jpg,depth.png,pose.txt}; stamp NNNNNN / 30 s; the depth
///   camera is registered to the colour camera.
/// - folder: images/, optional depth/ (same names, .png), poses.txt (4x4 world_from_camera a row),
///   K.txt; images in the order of their names; stamp row / fps, 10 frames per second by default.
/// - kitti: a sequence of KITTI odometry: image_0/ and image_1/ (grey) or image_2/ and image_3/
///   (colour), times.txt, calib.txt, optional ../../poses/NN.txt or poses.txt (3x4 a row, of camera
///   0); no depth.
/// - images: image files, in the folder or in its subfolder Images (City Centre and New College of
///   FAB-MAP: left and right in turn), in the order of their names, stamp index / fps; no depth.
/// - bag: a ROS 1 bag, an MCAP file or a ROS 2 bag in SQLite, or a folder of its parts; pictures,
///   raw or compressed, and calibration from topics; depth of another camera is registered by the
///   transforms in it.
///
/// Throws InputError, one sentence with file, line and what was expected, for everything that makes
/// the recording as a whole unusable. Single bad frames are left to RgbdSequence::read.
std::unique_ptr<RgbdSequence> open_sequence(const std::string& path,
                                            const SequenceOptions& options = {});

/// The format that open_sequence() reads the recording at `path` as, where `wanted` is auto or a
/// format. Throws InputError for what is no recording.
std::string recognised_format(const std::string& path, const std::string& wanted = "auto");

/// Throws InputError for images none of which has depth: for whatever needs depth.
void require_depth(const ImageOrigin& origin);

/// The true trajectory: of a file (`format` as in read_trajectory_file) or, for a folder, of the
/// recording in it or of EuRoC's state_groundtruth_estimate0. Throws InputError if there is none.
TrajectoryFile load_ground_truth(const std::string& file_or_folder,
                                 const std::string& format = "auto");

}  // namespace dxslam
