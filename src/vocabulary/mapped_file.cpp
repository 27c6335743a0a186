// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "vocabulary/mapped_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/error.h"

namespace dxslam {
namespace {

class Descriptor {
 public:
  explicit Descriptor(const std::string& path)
      : file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  ~Descriptor() {
    if (file_ >= 0) ::close(file_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return file_; }

 private:
  int file_;
};

[[noreturn]] void fail(const std::string& path, const std::string& expected) {
  throw InputError(
      fmt::format("{}: cannot be read: {}, expected {}", path, std::strerror(errno), expected));
}

}  // namespace

MappedFile::MappedFile(const std::string& path, const std::string& expected) {
  const Descriptor file(path);
  if (file.get() < 0) fail(path, expected);
  struct stat status{};
  if (::fstat(file.get(), &status) != 0) fail(path, expected);
  if (!S_ISREG(status.st_mode)) {
    throw InputError(fmt::format("{}: is no regular file, expected {}", path, expected));
  }
  size_ = static_cast<std::size_t>(status.st_size);
  if (size_ == 0) return;
  // All pages at once: a tree is read through when it is checked, and one call is quicker than
  // thousands of page faults.
  void* memory = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE | MAP_POPULATE, file.get(), 0);
  if (memory == MAP_FAILED) fail(path, expected);
  data_ = static_cast<const std::uint8_t*>(memory);
}

MappedFile::~MappedFile() {
  if (data_ != nullptr) ::munmap(const_cast<std::uint8_t*>(data_), size_);
}

}  // namespace dxslam
