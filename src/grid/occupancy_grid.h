// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "core/se3.h"
#include "grid/floor_scan.h"
#include "grid/grid_options.h"

namespace dxslam {

/// A floor plan as an image of cells, in the layout of nav_msgs/OccupancyGrid.
struct GridImage {
  static constexpr std::int8_t kUnknown = -1, kFree = 0, kOccupied = 100;

  double cell = 0.0;  ///< metres
  int width = 0, height = 0;
  double left = 0.0, bottom = 0.0;  ///< metres in the map: the corner of cell (0, 0)
  std::vector<std::int8_t> cells;   ///< row by row, x to the right, y upwards

  /// kUnknown outside.
  std::int8_t at(double x, double y) const;
};

/// The floor plan that the scans of many keyframes make. Each scan hangs on the pose of its
/// keyframe: where that moves, what the scan said is taken back and said anew, so that the plan
/// follows loop closures exactly. Not for two threads at once.
class OccupancyGrid {
 public:
  /// Throws InputError for options out of range.
  explicit OccupancyGrid(const GridOptions& options);

  /// A keyframe's scan, or another one of the same keyframe. Poses as in FloorScanner.
  void set(std::uint32_t keyframe, FloorScan scan, const SE3& map_from_camera);
  /// The keyframe is elsewhere now. One without a scan is passed over.
  void move(std::uint32_t keyframe, const SE3& map_from_camera);
  void remove(std::uint32_t keyframe);
  void clear();

  std::size_t scan_count() const { return scans_.size(); }
  /// The smallest image with all cells that were seen; empty if there are none.
  GridImage image() const;

 private:
  static constexpr int kTile = 64;  // cells a side
  struct Cell {
    std::int32_t hits = 0;    // scans that end here at something
    std::int32_t passes = 0;  // scans that show it free
  };
  using Tile = std::array<Cell, static_cast<std::size_t>(kTile) * kTile>;
  struct Placed {
    FloorScan scan;
    SE3 map_from_camera;
  };
  struct Index {
    int x = 0, y = 0;
  };

  bool is_within(const Eigen::Vector2d& point) const;
  Index index_of(const Eigen::Vector2d& point) const;
  Cell& cell_at(Index index);
  std::int8_t value_of(const Cell& cell) const;
  /// Counts a scan, by +1 or -1.
  void count(const Placed& placed, int sign);
  void walk(const Eigen::Vector2d& from, const Eigen::Vector2d& to, bool is_blocked);

  GridOptions options_;
  std::unordered_map<std::uint32_t, Placed> scans_;
  std::unordered_map<std::uint64_t, std::unique_ptr<Tile>> tiles_;
  // Of the scan that is counted: each cell once, whatever the number of rays through it.
  std::unordered_map<std::uint64_t, bool> marked_;
};

}  // namespace dxslam
