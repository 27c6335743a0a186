// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <deque>

#include "core/se3.h"
#include "io/primitives/scratch_file.h"
#include "map/id_table.h"
#include "map/map_types.h"

namespace dxslam {

/// Where keyframes hang that are no longer in the map. There are more of them every hour, so that
/// only the newest are in memory and the others in a temporary file, or, where none can be written,
/// in memory too. One thread at a time.
class RemovedKeyframes {
 public:
  struct Place {
    KeyframeId parent = kNoId;
    SE3 parent_from_camera;
  };

  /// An id is removed once.
  void add(KeyframeId id, const Place& place);
  /// Of one that was added. Throws InputError if the file cannot be read.
  Place find(KeyframeId id) const;

 private:
  IdTable<Place> in_memory_;
  std::deque<KeyframeId> order_;  // of those in memory
  ScratchFile file_;
};

}  // namespace dxslam
