// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "vocabulary/mapped_file.h"

#include <sys/mman.h>

#include "io/primitives/input_file.h"

namespace dxslam {

MappedFile::MappedFile(const std::string& path, const std::string& expected) {
  const InputFile file(path, expected);
  size_ = file.size();
  if (size_ == 0) return;
  // All pages at once: a tree is read through when it is checked, and one call is quicker than
  // thousands of page faults.
  void* memory =
      ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE | MAP_POPULATE, file.descriptor(), 0);
  if (memory == MAP_FAILED) file.fail();
  data_ = static_cast<const std::uint8_t*>(memory);
}

MappedFile::~MappedFile() {
  if (data_ != nullptr) ::munmap(const_cast<std::uint8_t*>(data_), size_);
}

}  // namespace dxslam
