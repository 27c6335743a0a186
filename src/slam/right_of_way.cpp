// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/right_of_way.h"

#include <algorithm>

namespace dxslam {

RightOfWay::Claim::Claim(RightOfWay& way) : way_(way) {
  const std::lock_guard lock(way_.mutex_);
  ++way_.claims_;
}

RightOfWay::Claim::~Claim() {
  const std::lock_guard lock(way_.mutex_);
  if (--way_.claims_ == 0) way_.free_.notify_all();
}

RightOfWay::Hurry::Hurry(RightOfWay& way) : way_(way) {
  const std::lock_guard lock(way_.mutex_);
  ++way_.hurries_;
  way_.free_.notify_all();
}

RightOfWay::Hurry::~Hurry() {
  const std::lock_guard lock(way_.mutex_);
  --way_.hurries_;
}

void RightOfWay::wait(std::chrono::steady_clock::duration longest) {
  std::unique_lock lock(mutex_);
  free_.wait_for(lock, longest, [this] { return claims_ == 0 || hurries_ > 0; });
}

void GiveWay::operator()() {
  const Clock::time_point arrived = Clock::now();
  credit_ = std::min<Clock::duration>(credit_ + (arrived - since_), kLongest);
  way_->wait(credit_);
  since_ = Clock::now();
  credit_ = std::max<Clock::duration>(credit_ - (since_ - arrived), Clock::duration(0));
}

}  // namespace dxslam
