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
#include "slam/observer.h"

namespace dxslam::apps {

/// Small pictures of the keyframes of one recording, for the map file: grey JPEG, 160 pixels wide
/// or less. Frames are made small when they are handed in and forgotten unless they become
/// keyframes, which the messages of the system tell. Any thread may call.
class Thumbnails {
 public:
  /// Nothing is made unless `wanted`. `stored` are those of a map that is gone on with, one a
  /// keyframe (hand_over).
  Thumbnails(bool wanted, std::vector<std::string> stored)
      : wanted_(wanted), stored_(std::move(stored)) {}

  /// Before the image is processed; images come in the order of their indices.
  void offer(const RgbdImage& image);
  /// When it was tracked: it is a keyframe, or it is not.
  void note(const TrackedFrame& frame);
  /// When it is in the map, which has lost some others.
  void note(const KeyframeMapped& mapped);
  /// One for each keyframe, by id, up to the last one there is; empty for keyframes without.
  std::vector<std::string> of(const Map& map) const;

 private:
  struct Small {
    std::int64_t index = 0;
    cv::Mat grey;
  };

  bool wanted_;
  std::vector<std::string> stored_;
  mutable std::mutex mutex_;
  std::deque<Small> waiting_;                       // not tracked yet
  std::map<std::int64_t, std::string> on_the_way_;  // to the map, by the index of the frame
  std::map<KeyframeId, std::string> in_map_;
};

}  // namespace dxslam::apps
