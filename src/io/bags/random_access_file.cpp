// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/bags/random_access_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/error.h"

namespace dxslam {

RandomAccessFile::RandomAccessFile(const std::string& path) : path_(path) {
  file_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file_ < 0) throw InputError(fmt::format("{}: {}", path, std::strerror(errno)));
  struct stat status{};
  if (::fstat(file_, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(file_);
    throw InputError(fmt::format("{}: not a regular file, expected a recording", path));
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

RandomAccessFile::~RandomAccessFile() { ::close(file_); }

std::string RandomAccessFile::read(std::uint64_t at, std::uint64_t count) const {
  if (at > size_ || count > size_ - at) {
    throw InputError(
        fmt::format("{}: ends at byte {}, expected {} bytes from {} on", path_, size_, count, at));
  }
  std::string bytes(count, '\0');
  std::uint64_t done = 0;
  while (done < count) {
    const ssize_t n =
        ::pread(file_, bytes.data() + done, count - done, static_cast<off_t>(at + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      throw InputError(fmt::format("{}: cannot be read at byte {}: {}", path_, at + done,
                                   n < 0 ? std::strerror(errno) : "it became shorter"));
    }
    done += static_cast<std::uint64_t>(n);
  }
  return bytes;
}

}  // namespace dxslam
