// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <string>

#include "io/primitives/file_lock.h"

namespace dxslam::apps {

/// The file that a command saves its map to, once or often. A map that is there already, and that
/// the command does not go on with, is kept as NAME.previous until the command ends well: a stop
/// or a failure costs it nothing. Where there is a NAME.previous already, NAME is of a command that
/// did not end well, and is replaced. One thread at a time.
class MapTarget {
 public:
  /// Takes the file for this process. `map_in`: the map that the command goes on with, or empty.
  /// Changes nothing. Throws InputError as lock_map_target() does, also for NAME.previous.
  MapTarget(std::string path, const std::string& map_in);

  const std::string& path() const { return path_; }
  /// To be called before each save. Makes the folder again where somebody removed it. Throws
  /// InputError if the map of before cannot be kept.
  void prepare();
  /// The command ended well: what was kept is removed.
  void finish();
  /// Where the map of before is, if this command replaced it; else empty.
  std::string kept() const;

 private:
  void keep() const;

  std::string path_;
  std::string target_;    // what is replaced
  std::string previous_;  // empty for a pipe or terminal
  bool goes_on_;
  bool prepared_ = false;
  std::unique_ptr<FileLock> lock_;
};

}  // namespace dxslam::apps
