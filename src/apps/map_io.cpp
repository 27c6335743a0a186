// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/map_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <optional>
#include <utility>

#include "apps/console.h"
#include "apps/failure.h"

namespace dxslam::apps {

std::optional<std::string> says_other_camera(const Rig& rig, const Camera& camera) {
  constexpr double kAlike = 0.03;  // of the image's side
  const auto is_alike = [&](const Camera& c) {
    const double side = kAlike * c.width;
    return c.width == camera.width && c.height == camera.height &&
           std::abs(c.fx - camera.fx) < side && std::abs(c.fy - camera.fy) < side &&
           std::abs(c.cx - camera.cx) < side && std::abs(c.cy - camera.cy) < side;
  };
  const std::vector<Camera>& known = rig.cameras();
  if (std::any_of(known.begin(), known.end(), is_alike)) return std::nullopt;
  const Camera& c = known.front();
  return fmt::format(
      "the map was made with another camera ({}x{}, fx {:.1f}, fy {:.1f}) than that of the images "
      "({}x{}, fx {:.1f}, fy {:.1f}): is the calibration right?",
      c.width, c.height, c.fx, c.fy, camera.width, camera.height, camera.fx, camera.fy);
}

void AutoSaver::note(const KeyframeMapped&) {
  if (++mapped_ % keyframes_ == 0 && !is_busy()) save();
}

bool AutoSaver::is_busy() const {
  return under_way_.valid() &&
         under_way_.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
}

void AutoSaver::save() {
  finish();
  attempt([this] {
    std::optional<MapSnapshot> snapshot;
    system_.read_map([&](const Map& map, const std::vector<LoopEdge>& loops) {
      snapshot = take_snapshot(header_, map, stored_loops(map, loops), pictures_(map));
    });
    if (!snapshot) return;  // an error is on its way
    target_.prepare();
    under_way_ = std::async(std::launch::async, [this, kept = std::move(*snapshot)] {
      save_map(target_.path(), kept);
      system_.events().publish(MapSaved{target_.path()});
    });
  });
}

void AutoSaver::finish() {
  if (!under_way_.valid()) return;
  attempt([this] { under_way_.get(); });
}

void AutoSaver::attempt(const std::function<void()>& step) {
  try {
    step();
  } catch (const std::exception& e) {
    if (!warned_) warn("autosave: {}; the run goes on and tries again", failure_of(e).sentence);
    warned_ = true;
  }
}

}  // namespace dxslam::apps
