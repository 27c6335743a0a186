// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace dxslam {

/// A file seen as memory, read-only. Pages are loaded when touched; the file may be unlinked or
/// replaced meanwhile, but must not be made shorter.
class MappedFile {
 public:
  /// Throws InputError if the file is missing, is no regular file or cannot be mapped; `expected`
  /// says what it should have been. An empty file has size 0.
  MappedFile(const std::string& path, const std::string& expected);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  const std::uint8_t* data() const { return data_; }
  std::size_t size() const { return size_; }

 private:
  const std::uint8_t* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace dxslam
