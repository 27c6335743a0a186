// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace dxslam {

/// Bytes on the disk instead of in memory: a temporary file without a name, which is gone when this
/// is, however the program ends. One thread at a time.
class ScratchFile {
 public:
  /// The file is made in `folder` by the first write(). Where that is empty, in $TMPDIR, /var/tmp
  /// or the system's folder for temporary files: the first of them that is on a disk, as a file in
  /// a tmpfs would be in memory after all.
  explicit ScratchFile(std::string folder = "");
  ~ScratchFile();
  ScratchFile(ScratchFile&& other) noexcept;
  ScratchFile& operator=(ScratchFile&& other) noexcept;

  /// False if there is no such folder, or the disk is full: keep the bytes then, and try again.
  bool write(const void* data, std::size_t bytes, std::uint64_t at);
  /// What was written there. Throws InputError if it cannot be read.
  void read(void* data, std::size_t bytes, std::uint64_t at) const;

 private:
  std::string folder_;
  int file_ = -1;
};

}  // namespace dxslam
