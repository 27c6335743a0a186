// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/thumbnails.h"

#include <algorithm>
#include <iterator>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "io/primitives/image_file.h"

namespace dxslam::apps {
namespace {

constexpr int kWidth = 160;  // pixels
constexpr int kQuality = 75;

cv::Mat small_grey(const cv::Mat& image) {
  cv::Mat grey = image;
  if (image.channels() == 3) cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  if (grey.cols <= kWidth) return grey.clone();
  cv::Mat small;
  const int height = std::max(1, grey.rows * kWidth / grey.cols);
  cv::resize(grey, small, cv::Size(kWidth, height), 0, 0, cv::INTER_AREA);
  return small;
}

}  // namespace

void Thumbnails::offer(const RgbdImage& image) {
  if (!wanted_) return;
  Small small{image.index, small_grey(image.color)};
  const std::lock_guard lock(mutex_);
  waiting_.push_back(std::move(small));
}

void Thumbnails::note(const TrackedFrame& frame) {
  const std::lock_guard lock(mutex_);
  // Those before it were dropped.
  while (!waiting_.empty() && waiting_.front().index < frame.index) waiting_.pop_front();
  if (waiting_.empty() || waiting_.front().index != frame.index) return;
  if (frame.is_keyframe) on_the_way_[frame.index] = encode_jpeg(waiting_.front().grey, kQuality);
  waiting_.pop_front();
}

void Thumbnails::note(const KeyframeMapped& mapped) {
  const std::lock_guard lock(mutex_);
  const auto made = on_the_way_.find(mapped.frame);
  if (made != on_the_way_.end()) {
    in_map_[mapped.report.keyframe] = std::move(made->second);
    on_the_way_.erase(on_the_way_.begin(), std::next(made));  // those before it never came
  }
  for (const KeyframeId id : mapped.report.culled_keyframes) in_map_.erase(id);
}

std::vector<std::string> Thumbnails::of(const Map& map) const {
  const std::lock_guard lock(mutex_);
  const std::vector<KeyframeId> ids = map.keyframe_ids();
  std::vector<std::string> all(ids.empty() ? 0 : ids.back() + std::size_t{1});
  std::copy_n(stored_.begin(), std::min(stored_.size(), all.size()), all.begin());
  for (const auto& [id, picture] : in_map_) {
    if (id < all.size()) all[id] = picture;
  }
  const bool none = std::all_of(all.begin(), all.end(), [](const auto& t) { return t.empty(); });
  return none ? std::vector<std::string>() : all;
}

}  // namespace dxslam::apps
