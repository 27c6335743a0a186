// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "core/frame.h"
#include "map/map.h"
#include "tracking/tracking_types.h"

namespace dxslam::apps {

/// Small pictures of the keyframes of one recording, for the map file: grey JPEG, 160 pixels wide
/// or less. Frames are made small when they are handed in and forgotten unless they become
/// keyframes. Any thread may call.
class Thumbnails {
 public:
  /// Nothing is made unless `wanted`. `stored` are those of a map that is gone on with, one a
  /// keyframe (hand_over).
  Thumbnails(bool wanted, std::vector<std::string> stored)
      : wanted_(wanted), stored_(std::move(stored)) {}

  /// Before the image is processed; images come in the order of their indices.
  void offer(const RgbdImage& image);
  /// When it was tracked.
  void note(const TrackedFrame& frame);
  /// One for each keyframe, by id, up to the last one there is; empty for keyframes without.
  std::vector<std::string> of(const Map& map) const;
  /// Lets those of keyframes go that were culled. Call now and then, with the map as it grows.
  void forget_culled(const Map& map);

 private:
  struct Small {
    std::int64_t index = 0;
    cv::Mat grey;
  };

  bool wanted_;
  std::vector<std::string> stored_;
  mutable std::mutex mutex_;
  std::deque<Small> waiting_;                  // not tracked yet
  std::map<std::int64_t, std::string> taken_;  // by the index of the frame
};

}  // namespace dxslam::apps
