// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/frame_log.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <type_traits>

#include "core/error.h"

namespace dxslam {
namespace {

using Numbers = std::array<double, 7>;

Numbers numbers_of(const SE3& pose) {
  const auto& q = pose.rotation().coeffs();
  const auto& t = pose.translation();
  return {q[0], q[1], q[2], q[3], t[0], t[1], t[2]};
}

SE3 pose_of(const Numbers& n) { return SE3::of_unit({n[3], n[0], n[1], n[2]}, {n[4], n[5], n[6]}); }

// Without a name from the start: nobody finds it, and it is gone with its descriptor.
int make_unnamed_file(const std::string& folder) {
  std::error_code error;
  const std::filesystem::path where =
      folder.empty() ? std::filesystem::temp_directory_path(error) : std::filesystem::path(folder);
  if (error) return -1;
  std::string name = (where / "dxslam-XXXXXX").string();
  const int file = mkostemp(name.data(), O_CLOEXEC);
  if (file >= 0) unlink(name.c_str());
  return file;
}

bool write_all(int file, const void* data, std::size_t bytes, off_t at) {
  const char* from = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t done = pwrite(file, from, bytes, at);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    from += done;
    at += done;
    bytes -= static_cast<std::size_t>(done);
  }
  return true;
}

void read_all(int file, void* data, std::size_t bytes, off_t at) {
  char* to = static_cast<char*>(data);
  while (bytes > 0) {
    const ssize_t done = pread(file, to, bytes, at);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) {
      throw InputError(fmt::format("the temporary file of tracked frames cannot be read: {}",
                                   done < 0 ? std::strerror(errno) : "it is too short"));
    }
    to += done;
    at += done;
    bytes -= static_cast<std::size_t>(done);
  }
}

}  // namespace

struct FrameLog::Record {
  std::int64_t index;
  double stamp;
  Numbers world_from_camera;
  Numbers reference_from_camera;
  double rms_pixels;
  std::uint32_t component;
  KeyframeId reference;
  std::int32_t keypoints;
  std::int32_t keypoints_with_depth;
  std::int32_t inliers;
  TrackingState state;
  bool is_keyframe;
  bool recovered;

  static Record of(const TrackedFrame& f) {
    // Does not compile when a field of the frame is forgotten here.
    [[maybe_unused]] const auto& [index_, stamp_, state_, world_from_camera_, component_,
                                  reference_, reference_from_camera_, keypoints_,
                                  keypoints_with_depth_, inliers_, is_keyframe_, recovered_,
                                  rms_pixels_] = f;
    Record r;
    std::memset(&r, 0, sizeof(r));  // the gaps too: they are written
    r.index = f.index;
    r.stamp = f.stamp;
    r.world_from_camera = numbers_of(f.world_from_camera);
    r.reference_from_camera = numbers_of(f.reference_from_camera);
    r.rms_pixels = f.rms_pixels;
    r.component = f.component;
    r.reference = f.reference;
    r.keypoints = f.keypoints;
    r.keypoints_with_depth = f.keypoints_with_depth;
    r.inliers = f.inliers;
    r.state = f.state;
    r.is_keyframe = f.is_keyframe;
    r.recovered = f.recovered;
    return r;
  }
  TrackedFrame frame() const {
    TrackedFrame f;
    f.index = index;
    f.stamp = stamp;
    f.state = state;
    f.world_from_camera = pose_of(world_from_camera);
    f.component = component;
    f.reference = reference;
    f.reference_from_camera = pose_of(reference_from_camera);
    f.keypoints = keypoints;
    f.keypoints_with_depth = keypoints_with_depth;
    f.inliers = inliers;
    f.is_keyframe = is_keyframe;
    f.recovered = recovered;
    f.rms_pixels = rms_pixels;
    return f;
  }
};

FrameLog::FrameLog(std::size_t block_frames, std::string folder)
    : block_frames_(block_frames), folder_(std::move(folder)) {
  static_assert(std::is_trivially_copyable_v<Record>, "records are written as they are");
  require(block_frames_ > 0, "a block must hold a frame");
}

FrameLog::~FrameLog() {
  if (file_ >= 0) close(file_);
}

void FrameLog::append(const TrackedFrame& frame) {
  if (size_ % block_frames_ == 0) {
    if (blocks_.size() >= written_ + 2) write_oldest();
    blocks_.emplace_back().reserve(block_frames_);
  }
  blocks_.back().push_back(Record::of(frame));
  ++size_;
}

void FrameLog::write_oldest() {
  if (usable_ && file_ < 0) file_ = make_unnamed_file(folder_);
  const std::size_t bytes = block_frames_ * sizeof(Record);
  usable_ = usable_ && file_ >= 0 &&
            write_all(file_, blocks_[written_].data(), bytes, static_cast<off_t>(written_ * bytes));
  if (usable_) Block().swap(blocks_[written_++]);
}

FrameLog::Block FrameLog::block(std::size_t number) const {
  if (number >= written_) return blocks_[number];
  Block block(block_frames_);
  const std::size_t bytes = block_frames_ * sizeof(Record);
  read_all(file_, block.data(), bytes, static_cast<off_t>(number * bytes));
  return block;
}

TrackedFrame FrameLog::operator[](std::size_t i) const {
  require(i < size_, "there is no frame of this number");
  const std::size_t number = i / block_frames_;
  if (number >= written_) return blocks_[number][i % block_frames_].frame();
  Record record;
  read_all(file_, &record, sizeof(record), static_cast<off_t>(i * sizeof(Record)));
  return record.frame();
}

void FrameLog::for_each(const std::function<void(const TrackedFrame&)>& visit) const {
  for (std::size_t number = 0; number < blocks_.size(); ++number) {
    for (const Record& record : block(number)) visit(record.frame());
  }
}

}  // namespace dxslam
