// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <deque>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "io/sources/live_camera.h"

namespace dxslam {

/// Colour and depth that belong together.
struct PicturePair {
  double stamp = 0.0;  ///< of colour
  cv::Mat color;
  cv::Mat raw_depth;  ///< empty of a camera without depth
};

/// Pairs two streams of pictures by their stamps while they come: each colour picture gets the
/// depth picture nearest in time, once a later one shows that none can be nearer. Keeps a second of
/// pictures at most. One thread.
class StreamPairing {
 public:
  /// `most` apart, seconds.
  StreamPairing(bool has_depth, double most) : has_depth_(has_depth), most_(most) {}

  void add(LivePicture picture);
  /// Pairs found and colour pictures left out since the last call, in order.
  std::vector<PicturePair> take_pairs();
  std::vector<std::string> take_problems();
  /// How long it is, in seconds of the pictures' clock, that colour came without depth, or depth
  /// without colour.
  double alone() const;
  /// The smallest difference of stamps while nothing fitted, seconds; 0 if there was no other.
  double nearest() const { return nearest_; }
  /// Whether any two fitted.
  bool has_paired() const { return has_paired_; }

 private:
  void pair();
  void leave_out(double stamp, std::string why);

  bool has_depth_;
  double most_;
  std::deque<LivePicture> colors_, depths_;
  std::vector<PicturePair> pairs_;
  std::vector<std::string> problems_;
  double last_color_ = -1.0, last_depth_ = -1.0;  // stamps
  double last_pair_ = -1.0, first_ = -1.0, newest_ = -1.0;
  double nearest_ = 0.0;
  bool has_paired_ = false;
};

}  // namespace dxslam
