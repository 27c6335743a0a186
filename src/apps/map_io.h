// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <functional>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "slam/stored_system.h"

namespace dxslam::apps {

/// A sentence where no camera of a map is like `camera`: one of both may be described wrongly, and
/// then nothing is found. Nothing where one is, within a few per cent.
std::optional<std::string> says_other_camera(const Rig& rig, const Camera& camera);

/// Saves a map in a thread of its own, so that mapping need not wait for the disk. A save that
/// fails is said once on stderr; the next one tries again. One thread at a time; nothing is thrown.
class AutoSaver {
 public:
  /// `on_saved` is called after a save, by the thread that calls save() or finish().
  AutoSaver(std::string path, MapHeader header, std::function<void()> on_saved)
      : path_(std::move(path)), header_(header), on_saved_(std::move(on_saved)) {}
  /// False while a save is under way: the next one has to be left out.
  bool is_ready();
  /// Copies the map and returns. Only when it is ready.
  void save(const Map& map, const std::vector<LoopEdge>& loops,
            const std::vector<std::string>& thumbnails);
  /// Waits for the save under way.
  void finish();

 private:
  void attempt(const std::function<void()>& step);

  std::string path_;
  MapHeader header_;
  std::function<void()> on_saved_;
  bool warned_ = false;
  std::future<void> under_way_;
};

}  // namespace dxslam::apps
