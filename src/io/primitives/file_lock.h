// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>

namespace dxslam {

/// Takes something for one process at a time: who has the lock has a lock on this file, which is
/// made for it and removed with it, also where its folder was moved meanwhile. What a killed
/// process leaves locks nobody out. A file system without locks is no reason to refuse.
class FileLock {
 public:
  /// Throws InputError with the sentence `in_use` if another has it, and std::system_error if the
  /// file cannot be made.
  FileLock(std::string path, const std::string& in_use);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  std::string path_;
  int file_ = -1;
  int folder_ = -1;  // that it is in, wherever that moves
};

}  // namespace dxslam
