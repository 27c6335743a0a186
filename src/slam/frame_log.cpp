// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/frame_log.h"

#include <cstring>
#include <type_traits>
#include <utility>

#include "core/error.h"
#include "core/pose_numbers.h"

namespace dxslam {

struct FrameLog::Record {
  std::int64_t index;
  double stamp;
  PoseNumbers world_from_camera;
  PoseNumbers reference_from_camera;
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
    : block_frames_(block_frames), file_(std::move(folder)) {
  static_assert(std::is_trivially_copyable_v<Record>, "records are written as they are");
  require(block_frames_ > 0, "a block must hold a frame");
}

FrameLog::~FrameLog() = default;

void FrameLog::append(const TrackedFrame& frame) {
  if (size_ % block_frames_ == 0) {
    while (blocks_.size() >= written_ + 2 && write_oldest()) {
    }
    blocks_.emplace_back().reserve(block_frames_);
  }
  blocks_.back().push_back(Record::of(frame));
  ++size_;
}

bool FrameLog::write_oldest() {
  const std::size_t bytes = block_frames_ * sizeof(Record);
  if (!file_.write(blocks_[written_].data(), bytes, written_ * bytes)) return false;
  Block().swap(blocks_[written_++]);
  return true;
}

FrameLog::Block FrameLog::block(std::size_t number) const {
  if (number >= written_) return blocks_[number];
  Block block(block_frames_);
  const std::size_t bytes = block_frames_ * sizeof(Record);
  file_.read(block.data(), bytes, number * bytes);
  return block;
}

TrackedFrame FrameLog::operator[](std::size_t i) const {
  require(i < size_, "there is no frame of this number");
  const std::size_t number = i / block_frames_;
  if (number >= written_) return blocks_[number][i % block_frames_].frame();
  Record record;
  file_.read(&record, sizeof(record), i * sizeof(Record));
  return record.frame();
}

void FrameLog::for_each(const std::function<void(const TrackedFrame&)>& visit) const {
  for (std::size_t number = 0; number < blocks_.size(); ++number) {
    for (const Record& record : block(number)) visit(record.frame());
  }
}

}  // namespace dxslam
