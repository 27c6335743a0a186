// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/map_io.h"

#include <chrono>
#include <exception>

#include "apps/console.h"

namespace dxslam::apps {

bool AutoSaver::is_ready() {
  return !under_way_.valid() ||
         under_way_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

void AutoSaver::save(const Map& map, const std::vector<LoopEdge>& loops,
                     const std::vector<std::string>& thumbnails) {
  finish();
  attempt([&] {
    under_way_ = std::async(
        std::launch::async,
        [path = path_, snapshot = take_snapshot(header_, map, stored_loops(map, loops),
                                                thumbnails)] { save_map(path, snapshot); });
  });
}

void AutoSaver::finish() {
  if (!under_way_.valid()) return;
  attempt([this] {
    under_way_.get();
    on_saved_();
  });
}

void AutoSaver::attempt(const std::function<void()>& step) {
  try {
    step();
  } catch (const std::exception& e) {
    if (!warned_) warn("autosave: {}; the run goes on and tries again", e.what());
    warned_ = true;
  }
}

}  // namespace dxslam::apps
