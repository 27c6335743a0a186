// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "synthetic/synthetic_sequence.h"

namespace dxslam {

struct TumWriterOptions {
  bool overwrite = false;  ///< replace the files of an earlier recording in the folder
  bool png = false;        ///< colour without loss; else JPEG of quality 95
  int threads = 2;         ///< frames drawn at once
  /// Told after each frame how many are done, from any of the threads but never from two at once;
  /// false stops the writing.
  std::function<bool(std::size_t done, std::size_t total)> progress;
};

/// Writes a TUM RGB-D folder: rgb/ and depth/ (16-bit PNG), rgb.txt, depth.txt, groundtruth.txt,
/// and beside them calibration.yaml (the camera) and scene.json (options, seed, path length,
/// frames), by which the folder is known as one of its own. Creates the folder. The lists are
/// written last; they hold the frames drawn, which are not all where progress stopped it: then it
/// returns false. Throws InputError if the folder has files in it and overwrite is off or they are
/// not of this function, or if a file cannot be written.
bool write_tum_sequence(const SyntheticSequence& sequence, const std::string& folder,
                        const TumWriterOptions& options);

/// Throws InputError if write_tum_sequence would refuse the folder. Changes nothing.
void require_usable_folder(const std::string& folder, bool overwrite);

/// scene.json of a recording.
std::string describe_scene(const SyntheticSequence& sequence);

}  // namespace dxslam
