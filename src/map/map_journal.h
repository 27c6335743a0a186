// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <vector>

#include "map/map_types.h"

namespace dxslam {

/// What became different in a map between two moments, by rising id. What came and went in between
/// is not in it.
struct MapChanges {
  std::vector<KeyframeId> added_keyframes;
  std::vector<KeyframeId> moved_keyframes;
  std::vector<KeyframeId> removed_keyframes;
  std::vector<PointId> added_points;
  std::vector<PointId> moved_points;
  std::vector<PointId> removed_points;

  bool empty() const {
    return added_keyframes.empty() && moved_keyframes.empty() && removed_keyframes.empty() &&
           added_points.empty() && moved_points.empty() && removed_points.empty();
  }
};

/// Takes down what is done to one kind of things with ids. Belongs to the thread of its map.
class Journal {
 public:
  using Id = std::uint32_t;

  void keep(bool on) {
    on_ = on;
    clear();
  }
  bool is_kept() const { return on_; }
  void add(Id id) { note(added_, id); }
  void move(Id id) { note(moved_, id); }
  void remove(Id id) { note(removed_, id); }

  /// Hands over what was noted, and begins anew.
  void take(std::vector<Id>& added, std::vector<Id>& moved, std::vector<Id>& removed);

 private:
  void note(std::vector<Id>& list, Id id) {
    if (on_) list.push_back(id);
  }
  void clear() {
    added_.clear();
    moved_.clear();
    removed_.clear();
  }

  bool on_ = false;
  std::vector<Id> added_;
  std::vector<Id> moved_;
  std::vector<Id> removed_;
};

}  // namespace dxslam
