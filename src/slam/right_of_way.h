// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace dxslam {

/// Frames come first: while one is being worked on, threads that give way wait, so that they do not
/// take its processors and caches. All calls may come from any thread.
class RightOfWay {
 public:
  /// While it lives, others give way.
  class Claim {
   public:
    explicit Claim(RightOfWay& way);
    ~Claim();
    Claim(const Claim&) = delete;
    Claim(Claim&&) = delete;
    Claim& operator=(const Claim&) = delete;
    Claim& operator=(Claim&&) = delete;

   private:
    RightOfWay& way_;
  };

  /// While it lives, nobody waits: one who gives way holds what this one needs.
  class Hurry {
   public:
    explicit Hurry(RightOfWay& way);
    ~Hurry();
    Hurry(const Hurry&) = delete;
    Hurry(Hurry&&) = delete;
    Hurry& operator=(const Hurry&) = delete;
    Hurry& operator=(Hurry&&) = delete;

   private:
    RightOfWay& way_;
  };

  /// Waits until nobody has a claim or somebody is in a hurry, but not longer than `longest`.
  void wait(std::chrono::steady_clock::duration longest);

 private:
  std::mutex mutex_;
  std::condition_variable free_;
  int claims_ = 0;   // guarded by mutex_
  int hurries_ = 0;  // guarded by mutex_
};

/// Makes one thread give way, by a call every few milliseconds of its work. It waits no longer than
/// it has worked, and a frame's time at most, so that it gets half of the time even where there is
/// always a frame: one that is never caught up with would be worse than a slow one. A copy starts
/// with what its original had; it is meant for another thread.
class GiveWay {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr Clock::duration kLongest = std::chrono::milliseconds(30);

  /// `way` must outlive this.
  explicit GiveWay(RightOfWay& way) : way_(&way) {}
  void operator()();

 private:
  RightOfWay* way_;
  Clock::time_point since_ = Clock::now();
  Clock::duration credit_{0};  // how long it may wait
};

}  // namespace dxslam
