// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "map_files/map_file.h"
#include "slam/system.h"
#include "slam/test_recording.h"

namespace dxslam::fuzz {

/// The images of these numbers; a negative number is an image that shows nothing.
std::vector<RgbdImage> images_of(const Recording& recording, const std::vector<int>& numbers);

/// In one thread, and few frames make many keyframes; `hasty` stops all adjustments after some
/// steps.
std::unique_ptr<System> make_system(const Recording& recording, const std::string& mode,
                                    bool hasty = false);

/// A map that the system made, and the recording that it was made of.
struct BaseMap {
  const Recording* recording = nullptr;
  MapSnapshot snapshot;
};

/// Small maps that the system made: of one component and of several, before and after these were
/// joined, with loops and thumbnails, of floats with global descriptors and of bytes without.
/// Always the same ones. `folder` is for files on the way.
class BaseMaps {
 public:
  explicit BaseMaps(const std::string& folder);

  const std::vector<BaseMap>& maps() const { return maps_; }

 private:
  StoredMap walk(const Recording& recording, const std::vector<int>& numbers) const;
  void add(const Recording& recording, const StoredMap& map);

  std::string folder_;
  Recording floats_{RecordingKind{160, 16, false}};
  Recording bytes_{RecordingKind{160, 16, true}};
  std::vector<BaseMap> maps_;
};

}  // namespace dxslam::fuzz
