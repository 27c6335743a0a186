// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <vector>

#include "core/trajectory.h"
#include "io/primitives/output_file.h"

namespace dxslam {

/// What a system said about one sequence of a scene, or the truth about it.
struct OpenlorisSequence {
  int number = 0;      ///< as in "seq: 1"
  bool aided = false;  ///< the system was told its first pose
  /// By rising stamp; empty if the system never knew where it was. Poses are world_from_frame of
  /// the frame that the file names.
  Trajectory poses;
  std::vector<double> output_times;  ///< clock when each pose was given, seconds; or empty
};

/// A result or ground-truth file of OpenLORIS-Scene: the sequences of one scene.
struct OpenlorisResult {
  std::string scene;
  std::string frame;                         ///< sensor whose poses these are, e.g. d400_color
  std::vector<OpenlorisSequence> sequences;  ///< by rising number, each number once
};

/// Reads such a file: "scene: NAME" and "frame: NAME", then for each sequence "seq: N" and rows
/// "stamp [output_time] x y z qx qy qz qw". Other "key: value" lines and comments are skipped, rows
/// with NaN dropped, rows sorted by stamp; of rows with the same stamp the last counts.
/// Throws InputError naming file and line for anything else.
OpenlorisResult read_openloris_result(const std::string& path);

/// Writes such a file, replaced atomically. Throws ContractError unless the invariants above hold.
void write_openloris_result(const std::string& path, const OpenlorisResult& result);

/// What write_openloris_result() writes.
FileKind openloris_kind();

}  // namespace dxslam
