// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/sources/stream_pairing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace dxslam {
namespace {

constexpr std::size_t kMostKept = 30;  // pictures of a stream: a second of most cameras

}  // namespace

void StreamPairing::leave_out(double stamp, std::string why) {
  problems_.push_back(fmt::format("the image at {:.6f}: {}", stamp, why));
}

void StreamPairing::add(LivePicture picture) {
  if (!picture.problem.empty()) return leave_out(picture.stamp, picture.problem);
  double& last = picture.is_depth ? last_depth_ : last_color_;
  if (picture.stamp <= last) {
    return leave_out(picture.stamp,
                     fmt::format("its stamp is not after the one before, {:.6f}", last));
  }
  last = picture.stamp;
  newest_ = std::max(newest_, picture.stamp);
  if (first_ < 0.0) first_ = picture.stamp;
  if (!has_depth_) {
    if (!picture.is_depth) pairs_.push_back({picture.stamp, std::move(picture.image), cv::Mat()});
    last_pair_ = newest_;
    return;
  }
  std::deque<LivePicture>& stream = picture.is_depth ? depths_ : colors_;
  stream.push_back(std::move(picture));
  pair();
  if (stream.size() <= kMostKept) return;
  if (!stream.front().is_depth) leave_out(stream.front().stamp, "no depth image came");
  stream.pop_front();
}

void StreamPairing::pair() {
  while (!colors_.empty() && !depths_.empty() && depths_.back().stamp >= colors_.front().stamp) {
    const double stamp = colors_.front().stamp;
    const auto off = [stamp](const LivePicture& depth) { return std::abs(depth.stamp - stamp); };
    const auto best = std::min_element(
        depths_.begin(), depths_.end(),
        [&](const LivePicture& a, const LivePicture& b) { return off(a) < off(b); });
    if (off(*best) <= most_) {
      pairs_.push_back({stamp, std::move(colors_.front().image), std::move(best->image)});
      depths_.erase(depths_.begin(), best + 1);
      last_pair_ = newest_;
      has_paired_ = true;
    } else {
      nearest_ = nearest_ == 0.0 ? off(*best) : std::min(nearest_, off(*best));
      leave_out(stamp, fmt::format("no depth image within {:g} s", most_));
      // What is older cannot be nearest to a later image, unless it is the last that there is.
      depths_.erase(depths_.begin(), best);
    }
    colors_.pop_front();
  }
}

std::vector<PicturePair> StreamPairing::take_pairs() { return std::exchange(pairs_, {}); }
std::vector<std::string> StreamPairing::take_problems() { return std::exchange(problems_, {}); }

double StreamPairing::alone() const { return newest_ - (last_pair_ < 0.0 ? first_ : last_pair_); }

}  // namespace dxslam
