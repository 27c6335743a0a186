// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map_files/file_bytes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/error.h"

namespace dxslam {
namespace {

class OpenFile {
 public:
  // Not blocking: opening a pipe must not wait for somebody to write to it.
  explicit OpenFile(const std::string& path)
      : file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  ~OpenFile() {
    if (file_ >= 0) ::close(file_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  int get() const { return file_; }

 private:
  int file_;
};

// How many bytes came; less than `size` where the file ends earlier or cannot be read.
std::size_t read_all(int file, char* to, std::size_t size) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t got = ::read(file, to + done, size - done);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

}  // namespace

FileBytes::FileBytes(const std::string& path, const std::string& expected, std::size_t max_bytes) {
  const OpenFile file(path);
  if (file.get() < 0) {
    throw InputError(errno == ENOENT ? fmt::format("{}: no such file, expected {}", path, expected)
                                     : fmt::format("{}: cannot be read, expected {}: {}", path,
                                                   expected, std::strerror(errno)));
  }
  struct stat status{};
  if (::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) {
    throw InputError(fmt::format("{}: not a regular file, expected {}", path, expected));
  }
  size_ = static_cast<std::size_t>(status.st_size);
  if (size_ > max_bytes) {
    throw InputError(fmt::format("{}: {} bytes, expected {} of at most {} bytes", path, size_,
                                 expected, max_bytes));
  }
  bytes_.reset(new char[size_]);
  if (read_all(file.get(), bytes_.get(), size_) != size_) {
    throw InputError(fmt::format("{}: cannot be read, expected {}", path, expected));
  }
}

}  // namespace dxslam
