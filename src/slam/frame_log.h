// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "io/primitives/scratch_file.h"
#include "tracking/tracking_types.h"

namespace dxslam {

/// Every frame that was tracked, in order, in bounded memory: the newest are kept there, the others
/// go to a temporary file (io/primitives/scratch_file.h). As long as no such file can be made or
/// written, they stay in memory. Frames come back to the bit.
/// Belongs to one thread at a time.
class FrameLog {
 public:
  /// One or two blocks of `block_frames` are in memory. `folder` is that of a ScratchFile.
  explicit FrameLog(std::size_t block_frames = 2048, std::string folder = "");
  ~FrameLog();
  FrameLog(const FrameLog&) = delete;
  FrameLog& operator=(const FrameLog&) = delete;

  void append(const TrackedFrame& frame);
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }

  /// Reads frame `i`, less than size(). Throws InputError if the file cannot be read.
  TrackedFrame operator[](std::size_t i) const;
  /// All in order, a block at a time. Throws likewise.
  void for_each(const std::function<void(const TrackedFrame&)>& visit) const;

 private:
  struct Record;
  using Block = std::vector<Record>;

  bool write_oldest();
  Block block(std::size_t number) const;

  std::size_t block_frames_;
  std::vector<Block> blocks_;  // those in the file are empty here
  std::size_t written_ = 0;    // blocks in the file
  std::size_t size_ = 0;
  ScratchFile file_;
};

}  // namespace dxslam
