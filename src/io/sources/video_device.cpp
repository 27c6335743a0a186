// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/sources/video_device.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "core/error.h"

namespace dxslam {
namespace {

class KernelDevice : public VideoDevice {
 public:
  explicit KernelDevice(const std::string& path)
      : file_(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)) {
    if (file_ < 0) {
      throw InputError(fmt::format("{}: cannot be opened: {}, expected a video device", path,
                                   std::strerror(errno)));
    }
    struct stat status{};
    if (::fstat(file_, &status) == 0 && S_ISCHR(status.st_mode)) return;
    ::close(file_);
    throw InputError(path + ": no device, expected a video device such as /dev/video0");
  }
  ~KernelDevice() override {
    for (const auto& [start, length] : mapped_) ::munmap(start, length);
    ::close(file_);
  }
  KernelDevice(const KernelDevice&) = delete;
  KernelDevice& operator=(const KernelDevice&) = delete;

  int control(unsigned long request, void* argument) override {
    for (;;) {
      if (::ioctl(file_, request, argument) == 0) return 0;
      if (errno != EINTR) return errno;
    }
  }
  const char* map(std::size_t length, std::uint32_t offset) override {
    void* start = ::mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_SHARED, file_, offset);
    if (start == MAP_FAILED) return nullptr;
    mapped_.emplace_back(start, length);
    return static_cast<const char*>(start);
  }
  int descriptor() const override { return file_; }

 private:
  int file_;
  std::vector<std::pair<void*, std::size_t>> mapped_;
};

}  // namespace

std::unique_ptr<VideoDevice> open_video_device(const std::string& path) {
  return std::make_unique<KernelDevice>(path);
}

}  // namespace dxslam
