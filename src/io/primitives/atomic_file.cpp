// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "core/error.h"
#include "io/primitives/temporary_file.h"

namespace dxslam {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPipePiece = 4096;  // a pipe that is ready takes as much (PIPE_BUF)
constexpr int kSlice = 50;                // ms
constexpr int kMostLinks = 40;            // as the kernel has it

std::atomic<bool> waits_for_readers{true};

[[noreturn]] void fail(const std::string& path, int error) {
  const char* const reason = error == ENXIO || error == EPIPE ? "nobody reads from this pipe"
                             : error == ETIMEDOUT             ? "nobody read from this pipe"
                                                              : std::strerror(error);
  throw InputError(fmt::format("{}: cannot be written: {}", path, reason));
}

std::string folder_of(const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

// The new name is durable once its folder is; a folder that cannot be synced is no failure.
void sync_folder_of(const std::string& path) {
  const int directory = ::open(folder_of(path).c_str(), O_RDONLY | O_CLOEXEC);
  if (directory < 0) return;
  ::fsync(directory);
  ::close(directory);
}

// 0 or the errno of what failed.
int write_to_stream(int stream, std::string_view bytes) {
  while (!bytes.empty()) {
    pollfd ready{stream, POLLOUT, 0};
    if (::poll(&ready, 1, kSlice) == 0) {
      if (!waits_for_readers) return ETIMEDOUT;
      continue;
    }
    const ssize_t written = ::write(stream, bytes.data(), std::min(bytes.size(), kPipePiece));
    if (written < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (written < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

// 1 or 2 where `path` stands for stdout or stderr; -1 for all else.
int console_descriptor(const std::string& path) {
  for (const int descriptor : {STDOUT_FILENO, STDERR_FILENO}) {
    if (path == (descriptor == STDOUT_FILENO ? "/dev/stdout" : "/dev/stderr") ||
        path == fmt::format("/dev/fd/{}", descriptor) ||
        path == fmt::format("/proc/self/fd/{}", descriptor)) {
      return descriptor;
    }
  }
  return -1;
}

// Not blocking: opening a pipe must not wait for somebody to read from it. The console is written
// to where it stands, also if it is a file.
int open_stream(const std::string& path) {
  const int console = console_descriptor(path);
  const int stream = console >= 0
                         ? ::dup(console)
                         : ::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (stream < 0) fail(path, errno);
  return stream;
}

void write_stream(const std::string& path, std::string_view bytes) {
  const int stream = open_stream(path);
  int error = write_to_stream(stream, bytes);
  if (::close(stream) != 0 && error == 0) error = errno;
  if (error != 0) fail(path, error);
}

// What `path` is; st_mode 0 for what is not there.
struct stat status_of(const std::string& path) {
  struct stat status{};
  if (::stat(path.c_str(), &status) == 0) return status;
  if (errno != ENOENT) fail(path, errno);
  return {};
}

bool is_stream(const std::string& path, const struct stat& status) {
  return status.st_mode != 0 && (!S_ISREG(status.st_mode) || console_descriptor(path) >= 0);
}

// A file that its owner protected from writing is not replaced either.
void require_replaceable(const std::string& path, const struct stat& status) {
  if (status.st_mode != 0 && ::access(path.c_str(), W_OK) != 0) fail(path, errno);
}

}  // namespace

std::string target_behind_links(const std::string& path) {
  fs::path target = path;
  std::error_code error;
  for (int links = 0; links < kMostLinks && fs::is_symlink(target, error); ++links) {
    const fs::path next = fs::read_symlink(target, error);
    if (error) break;
    target = next.is_absolute() ? next : target.parent_path() / next;
  }
  return target.string();
}

void write_file_atomically(const std::string& path, std::string_view bytes) {
  const struct stat status = status_of(path);
  if (is_stream(path, status)) {
    write_stream(path, bytes);
    return;
  }
  const std::shared_lock lock(files_being_written());
  require_replaceable(path, status);
  const std::string target = target_behind_links(path);
  try {
    TemporaryFile file(target);
    if (status.st_mode != 0) file.take_rights_of(status);
    file.write(bytes);
    file.publish();
  } catch (const std::system_error& e) {
    fail(path, e.code().value());
  }
  sync_folder_of(target);
}

void require_writable(const std::string& path) {
  const struct stat status = status_of(path);
  if (is_stream(path, status)) {
    ::close(open_stream(path));
    return;
  }
  require_replaceable(path, status);
  try {
    TemporaryFile file(target_behind_links(path));
  } catch (const std::system_error& e) {
    fail(path, e.code().value());
  }
}

void make_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  std::error_code no_link;
  const fs::path leads_to = fs::read_symlink(folder, no_link);
  if (error && !no_link && !fs::exists(folder, no_link) && !no_link) {
    throw InputError(fmt::format("output folder {} is a link to {}, which is not there", folder,
                                 leads_to.string()));
  }
  if (error) {
    throw InputError(fmt::format("output folder {} cannot be made: {}", folder, error.message()));
  }
  remove_temporaries_in(folder, "");
}

void remove_stale_temporaries(const std::string& path) {
  const std::string target = target_behind_links(path);
  remove_temporaries_in(folder_of(target), fs::path(target).filename().string());
}

std::shared_mutex& files_being_written() {
  static std::shared_mutex& mutex = *new std::shared_mutex;  // outlives every thread
  return mutex;
}

void stop_waiting_for_readers() { waits_for_readers = false; }

}  // namespace dxslam
