// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "apps/map_target.h"
#include "slam/observer.h"
#include "slam/stored_system.h"
#include "slam/system.h"

namespace dxslam::apps {

/// A sentence where no camera of a map is like `camera`: one of both may be described wrongly, and
/// then nothing is found. Nothing where one is, within a few per cent.
std::optional<std::string> says_other_camera(const Rig& rig, const Camera& camera);

/// Saves the map of a system after every so many keyframes: a reader of its KeyframeMapped. The
/// file is written in a thread of its own, so that nobody waits for the disk. A save that fails is
/// said once on stderr; the next one tries again. One that succeeds is told as MapSaved. One thread
/// at a time; nothing is thrown.
class AutoSaver {
 public:
  /// Pictures of the map's keyframes, as take_snapshot() wants them.
  using Pictures = std::function<std::vector<std::string>(const Map&)>;

  /// Both references must outlive this, or the call of finish().
  AutoSaver(System& system, MapTarget& target, int keyframes, MapHeader header, Pictures pictures)
      : system_(system),
        target_(target),
        keyframes_(keyframes),
        header_(std::move(header)),
        pictures_(std::move(pictures)) {}

  /// A keyframe came into the map.
  void note(const KeyframeMapped& mapped);
  /// Waits for the save under way.
  void finish();

 private:
  bool is_busy() const;
  void save();
  void attempt(const std::function<void()>& step);

  System& system_;
  MapTarget& target_;
  const int keyframes_;
  const MapHeader header_;
  const Pictures pictures_;
  std::int64_t mapped_ = 0;
  bool warned_ = false;
  std::future<void> under_way_;
};

}  // namespace dxslam::apps
