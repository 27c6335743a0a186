// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "grid/occupancy_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace dxslam {
namespace {

// A move by less changes no cell worth speaking of.
constexpr double kMovedCells = 0.1;
constexpr double kTurned = 0.001;  // radians: 4 mm at 4 m

std::uint64_t key_of(int x, int y) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32U |
         static_cast<std::uint32_t>(y);
}
int x_of(std::uint64_t key) { return static_cast<int>(static_cast<std::uint32_t>(key >> 32U)); }
int y_of(std::uint64_t key) { return static_cast<int>(static_cast<std::uint32_t>(key)); }

int divided_down(int value, int by) { return value >= 0 ? value / by : -((by - 1 - value) / by); }

}  // namespace

std::int8_t GridImage::at(double x, double y) const {
  const double column = std::floor((x - left) / cell);
  const double row = std::floor((y - bottom) / cell);
  if (!(column >= 0.0 && row >= 0.0 && column < width && row < height)) return kUnknown;
  return cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(column)];
}

OccupancyGrid::OccupancyGrid(const GridOptions& options) : options_(options) {
  validate_options("grid", options_);
}

void OccupancyGrid::set(std::uint32_t keyframe, FloorScan scan, const SE3& map_from_camera) {
  remove(keyframe);
  const Placed& placed =
      scans_.emplace(keyframe, Placed{std::move(scan), map_from_camera}).first->second;
  count(placed, 1);
}

void OccupancyGrid::move(std::uint32_t keyframe, const SE3& map_from_camera) {
  const auto found = scans_.find(keyframe);
  if (found == scans_.end()) return;
  Placed& placed = found->second;
  if (translation_distance(placed.map_from_camera, map_from_camera) < kMovedCells * options_.cell &&
      rotation_angle(placed.map_from_camera, map_from_camera) < kTurned) {
    return;
  }
  count(placed, -1);
  placed.map_from_camera = map_from_camera;
  count(placed, 1);
}

void OccupancyGrid::remove(std::uint32_t keyframe) {
  const auto found = scans_.find(keyframe);
  if (found == scans_.end()) return;
  count(found->second, -1);
  scans_.erase(found);
}

void OccupancyGrid::clear() {
  scans_.clear();
  tiles_.clear();
}

GridImage OccupancyGrid::image() const {
  Index low{std::numeric_limits<int>::max(), std::numeric_limits<int>::max()};
  Index high{std::numeric_limits<int>::min(), std::numeric_limits<int>::min()};
  const auto for_each = [&](const auto& visit) {
    for (const auto& [key, tile] : tiles_) {
      for (int i = 0; i < kTile * kTile; ++i) {
        const std::int8_t value = value_of((*tile)[static_cast<std::size_t>(i)]);
        if (value == GridImage::kUnknown) continue;
        visit(Index{x_of(key) * kTile + i % kTile, y_of(key) * kTile + i / kTile}, value);
      }
    }
  };
  for_each([&](Index at, std::int8_t) {
    low = {std::min(low.x, at.x), std::min(low.y, at.y)};
    high = {std::max(high.x, at.x), std::max(high.y, at.y)};
  });
  GridImage image;
  image.cell = options_.cell;
  if (low.x > high.x) return image;
  image.width = high.x - low.x + 1;
  image.height = high.y - low.y + 1;
  image.left = low.x * options_.cell;
  image.bottom = low.y * options_.cell;
  const auto width = static_cast<std::size_t>(image.width);
  image.cells.assign(width * static_cast<std::size_t>(image.height), GridImage::kUnknown);
  for_each([&](Index at, std::int8_t value) {
    image.cells[static_cast<std::size_t>(at.y - low.y) * width +
                static_cast<std::size_t>(at.x - low.x)] = value;
  });
  return image;
}

bool OccupancyGrid::is_within(const Eigen::Vector2d& point) const {
  return point.cwiseAbs().maxCoeff() <= options_.max_extent;  // false for what is not a number
}

OccupancyGrid::Index OccupancyGrid::index_of(const Eigen::Vector2d& point) const {
  return {static_cast<int>(std::floor(point.x() / options_.cell)),
          static_cast<int>(std::floor(point.y() / options_.cell))};
}

OccupancyGrid::Cell& OccupancyGrid::cell_at(Index index) {
  const int tile_x = divided_down(index.x, kTile);
  const int tile_y = divided_down(index.y, kTile);
  std::unique_ptr<Tile>& tile = tiles_[key_of(tile_x, tile_y)];
  if (!tile) tile = std::make_unique<Tile>();
  return (*tile)[static_cast<std::size_t>((index.y - tile_y * kTile) * kTile + index.x -
                                          tile_x * kTile)];
}

std::int8_t OccupancyGrid::value_of(const Cell& cell) const {
  if (cell.hits + cell.passes == 0) return GridImage::kUnknown;
  const double share = static_cast<double>(cell.hits) / (cell.hits + cell.passes);
  if (cell.hits >= options_.min_hits && share >= options_.min_hit_share) {
    return GridImage::kOccupied;
  }
  return cell.passes > 0 ? GridImage::kFree : GridImage::kUnknown;
}

void OccupancyGrid::count(const Placed& placed, int sign) {
  const Eigen::Vector2d from = placed.map_from_camera.translation().head<2>();
  marked_.clear();
  for (const FloorScan::Ray& ray : placed.scan.rays) {
    const Eigen::Vector3d end = placed.map_from_camera * ray.end_in_camera.cast<double>();
    walk(from, end.head<2>(), ray.is_blocked);
  }
  for (const auto& [key, is_hit] : marked_) {
    Cell& cell = cell_at({x_of(key), y_of(key)});
    (is_hit ? cell.hits : cell.passes) += sign;
  }
}

// From cell to cell along the line (Amanatides and Woo, 1987). The last is the obstacle's.
void OccupancyGrid::walk(const Eigen::Vector2d& from, const Eigen::Vector2d& to, bool is_blocked) {
  if (!is_within(from) || !is_within(to)) return;
  const Eigen::Vector2d way = to - from;
  const Index last = index_of(to);
  Index at = index_of(from);
  const Index step{way.x() > 0.0 ? 1 : -1, way.y() > 0.0 ? 1 : -1};
  const auto to_next = [&](double start, double along, int index, int direction) {
    if (along == 0.0) return std::numeric_limits<double>::infinity();
    return ((index + (direction > 0 ? 1 : 0)) * options_.cell - start) / along;
  };
  double next_x = to_next(from.x(), way.x(), at.x, step.x);
  double next_y = to_next(from.y(), way.y(), at.y, step.y);
  const double per_x = options_.cell / std::abs(way.x());
  const double per_y = options_.cell / std::abs(way.y());
  int left = std::abs(last.x - at.x) + std::abs(last.y - at.y);
  for (; left > 0; --left) {
    marked_.try_emplace(key_of(at.x, at.y), false);
    if (next_x < next_y) {
      at.x += step.x;
      next_x += per_x;
    } else {
      at.y += step.y;
      next_y += per_y;
    }
  }
  bool& is_hit = marked_.try_emplace(key_of(last.x, last.y), false).first->second;
  is_hit = is_hit || is_blocked;
}

}  // namespace dxslam
