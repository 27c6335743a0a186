// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/console.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>

#include "apps/process.h"

namespace dxslam::apps {
namespace {

// A pipe that is ready takes as much at once without blocking (PIPE_BUF).
constexpr std::size_t kPiece = 4096;
constexpr int kSlice = 50;               // ms, between two looks at the stop
constexpr int kPatienceOfWarnings = 20;  // slices

std::atomic<int> first_stdout_error{0};

bool ready(int descriptor, int milliseconds) {
  pollfd waiting{descriptor, POLLOUT, 0};
  return ::poll(&waiting, 1, milliseconds) != 0;  // errors show at the write
}

// Waits for whoever reads, `slices` at most (below 0: without end), and never beyond a stop. 0 or
// the errno of what failed.
int write_text(int descriptor, std::string_view text, int slices) {
  while (!text.empty()) {
    if (!ready(descriptor, slices == 0 ? 0 : kSlice)) {
      if (slices == 0 || stop_requested()) return ETIMEDOUT;
      if (slices > 0) --slices;
      continue;
    }
    const ssize_t written = ::write(descriptor, text.data(), std::min(text.size(), kPiece));
    if (written < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (written < 0) return errno;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

}  // namespace

void print_text(std::string_view text) {
  if (first_stdout_error != 0) return;
  if (const int error = write_text(STDOUT_FILENO, text, -1); error != 0) {
    first_stdout_error = error;
  }
}

void warn_text(std::string_view text) {
  const std::string line = "dxslam: " + printable(text) + "\n";
  write_text(STDERR_FILENO, line, kPatienceOfWarnings);
}

void draw_text(std::string_view text) { write_text(STDERR_FILENO, text, 0); }

std::string counted(std::size_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

int stdout_error() { return first_stdout_error; }

}  // namespace dxslam::apps
