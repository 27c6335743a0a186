// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/file.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>

#include "core/error.h"

namespace dxslam {
namespace {

// Writes all bytes and flushes them; 0 or the errno of what failed.
int write_and_sync(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  // Pipes and terminals say EINVAL: they have no disk.
  return ::fsync(file) == 0 || errno == EINVAL ? 0 : errno;
}

int write_and_close(int file, std::string_view bytes) {
  const int error = write_and_sync(file, bytes);
  const int close_error = ::close(file) == 0 ? 0 : errno;
  return error != 0 ? error : close_error;
}

[[noreturn]] void fail(const std::string& path, int error) {
  throw InputError(fmt::format("{}: cannot be written: {}", path, std::strerror(error)));
}

// Behind a link it is the file that is replaced, not the link.
std::string target_of(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  return fs::exists(path, ignored) ? fs::canonical(path).string() : path;
}

std::string temporary_of(const std::string& target, int process, unsigned number) {
  return fmt::format("{}.{}.{}.tmp", target, process, number);
}

// The process that made `name` as a temporary file of `target`; nothing for other files.
std::optional<pid_t> maker_of(const std::string& name, const std::string& target) {
  if (name.compare(0, target.size() + 1, target + ".") != 0) return std::nullopt;
  const char* const end = name.data() + name.size();
  pid_t process = 0;
  const auto first = std::from_chars(name.data() + target.size() + 1, end, process);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != '.') return std::nullopt;
  unsigned number = 0;
  const auto second = std::from_chars(first.ptr + 1, end, number);
  if (second.ec != std::errc()) return std::nullopt;
  if (process <= 0 || name != temporary_of(target, process, number)) return std::nullopt;
  return process;
}

// Whoever writes a temporary file holds its lock, also where the process cannot be seen from here
// (another container on the same folder).
void remove_unless_locked(const std::string& temporary) {
  const int file = ::open(temporary.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0) return;
  if (::flock(file, LOCK_EX | LOCK_NB) == 0) ::unlink(temporary.c_str());
  ::close(file);
}

// The new name is durable once its folder is; a folder that cannot be synced is no failure.
void sync_folder_of(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  const int directory = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_CLOEXEC);
  if (directory < 0) return;
  ::fsync(directory);
  ::close(directory);
}

}  // namespace

void write_file_atomically(const std::string& path, std::string_view bytes) {
  static std::atomic<unsigned> counter{0};
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    const int device = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (device < 0) fail(path, errno);
    if (const int error = write_and_close(device, bytes); error != 0) fail(path, error);
    return;
  }
  const std::string target = target_of(path);
  const std::string temporary = temporary_of(target, ::getpid(), counter++);
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) fail(path, errno);
  ::flock(file, LOCK_EX | LOCK_NB);  // until it is closed
  int error = write_and_sync(file, bytes);
  if (error == 0 && std::rename(temporary.c_str(), target.c_str()) != 0) error = errno;
  ::close(file);
  if (error != 0) {
    ::unlink(temporary.c_str());
    fail(path, error);
  }
  sync_folder_of(target);
}

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw InputError(fmt::format("output folder {} cannot be made: {}", folder, error.message()));
  }
}

void remove_stale_temporaries(const std::string& path) {
  namespace fs = std::filesystem;
  const fs::path target = target_of(path);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    const std::optional<pid_t> maker = maker_of(name, target.filename().string());
    if (maker && ::kill(*maker, 0) != 0 && errno == ESRCH) remove_unless_locked(it->path());
  }
}

}  // namespace dxslam
