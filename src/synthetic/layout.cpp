// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/layout.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "synthetic/furnish.h"
#include "synthetic/random.h"

namespace dxslam {
namespace {

using Eigen::Vector2d;

constexpr double kHalfWall = 0.075;  // metres, half the thickness between two rooms
constexpr double kDoorway = 1.2;     // metres

Pattern wall_pattern(Random& random) {
  static constexpr Pattern kPatterns[] = {
      Pattern::kPlaster,   Pattern::kBrick,   Pattern::kStone, Pattern::kConcrete,
      Pattern::kWallpaper, Pattern::kPlaster, Pattern::kMosaic};
  return kPatterns[random.integer(7)];
}

Pattern floor_pattern(Random& random) {
  static constexpr Pattern kPatterns[] = {Pattern::kPlanks, Pattern::kTiles, Pattern::kCarpet,
                                          Pattern::kPlanks};
  return kPatterns[random.integer(4)];
}

Eigen::Vector3f soft_tint(Random& random) {
  const double value = random.uniform(0.8, 1.1);
  return Eigen::Vector3d(value * random.uniform(0.85, 1.0), value * random.uniform(0.9, 1.0), value)
      .cast<float>();
}

struct Room {
  Vector2d low, high;
  Vector2d centre() const { return 0.5 * (low + high); }
};

// The four walls of a room in the order north, east, south, west, seen from inside.
std::vector<Wall> walls_of(const Room& room, Random& random) {
  const Vector2d sw = room.low, ne = room.high, nw(sw.x(), ne.y()), se(ne.x(), sw.y());
  std::vector<Wall> walls(4);
  const Vector2d corners[5] = {nw, ne, se, sw, nw};
  for (int i = 0; i < 4; ++i) {
    walls[i].from = corners[i];
    walls[i].to = corners[i + 1];
    walls[i].pattern = wall_pattern(random);
    walls[i].variant = random.integer(2);
    walls[i].tint = soft_tint(random);
  }
  return walls;
}

void add_slab(Layout& layout, const Room& room, Random& random) {
  const Vector2d margin = Vector2d::Constant(kHalfWall);
  layout.slabs.push_back({room.low - margin, room.high + margin, floor_pattern(random),
                          random.integer(2), random.integer(2)});
}

void add_ceiling_lamps(Layout& layout, const Room& room, int along_x, int along_y, Random& random) {
  const Vector2d size = room.high - room.low;
  for (int i = 0; i < along_x * along_y; ++i) {
    const Vector2d at = room.low + size.cwiseProduct(Vector2d((i % along_x + 0.5) / along_x,
                                                              (i / along_x + 0.5) / along_y));
    Lamp lamp;
    lamp.position = {at.x(), at.y(), layout.height - 0.03};
    const double power = random.uniform(2.2, 3.4), warmth = random.uniform(0.75, 1.0);
    lamp.color = Eigen::Vector3d(power * warmth, power * (0.5 + 0.5 * warmth), power).cast<float>();
    layout.lamps.push_back(lamp);
  }
}

void furnish_room(Layout& layout, const Room& room, const std::vector<Wall>& walls, bool windows,
                  Random& random) {
  for (const Wall& wall : walls) {
    FurnishOptions options;
    options.area_min = room.low;
    options.area_max = room.high;
    options.windows = windows;
    furnish_wall(layout, wall, options, random);
    layout.walls.push_back(wall);
  }
}

Layout make_room(Random& random) {
  Layout layout;
  const Room room{{0.0, 0.0}, {7.0, 6.0}};
  layout.path = {{2.0, 1.9}, {3.5, 1.7}, {5.0, 1.9}, {5.35, 3.0},
                 {5.0, 4.1}, {3.5, 4.3}, {2.0, 4.1}, {1.65, 3.0}};
  layout.overlap = 1.5;
  layout.side_look = -0.45;
  std::vector<Wall> walls = walls_of(room, random);
  for (int i = 0; i < 4; ++i) {  // no two walls alike
    static constexpr Pattern kWalls[4] = {Pattern::kPlaster, Pattern::kBrick, Pattern::kWallpaper,
                                          Pattern::kConcrete};
    walls[i].pattern = kWalls[i];
  }
  add_slab(layout, room, random);
  add_ceiling_lamps(layout, room, 2, 2, random);
  furnish_room(layout, room, walls, true, random);
  add_centre_piece(layout, room.centre(), random);
  return layout;
}

void add_opening(Wall& wall, const Vector2d& at) {
  const double s = (at - wall.from).dot(wall.direction());
  wall.openings.push_back({s - kDoorway / 2, s + kDoorway / 2});
}

// Into a room through its door, once around its middle, and out again.
void visit_room(Layout& layout, const Room& room, const Vector2d& door, double inwards) {
  const Vector2d c = room.centre();
  const double r = 0.75;
  for (const double y : {-1.3, -0.6, 0.0, 0.6, 1.1})
    layout.path.push_back(door + Vector2d(0.0, y * inwards));
  layout.path.push_back(c + Vector2d(r, -0.4 * r * inwards));
  layout.path.push_back(c + Vector2d(0.7 * r, 0.8 * r * inwards));
  layout.path.push_back(c + Vector2d(-0.7 * r, 0.8 * r * inwards));
  layout.path.push_back(c + Vector2d(-r, -0.4 * r * inwards));
  for (const double y : {1.1, 0.6, 0.0, -0.6, -1.3})
    layout.path.push_back(door + Vector2d(0.0, y * inwards));
}

// A hall with three rooms to the north and two to the south, all doors open.
Layout make_office(Random& random) {
  Layout layout;
  const Room hall{{0.0, 0.0}, {14.4, 2.6}};
  const double north = hall.high.y() + 2 * kHalfWall, south = hall.low.y() - 2 * kHalfWall;
  const std::vector<Room> rooms = {{{0.0, north}, {4.7, north + 4.6}},
                                   {{4.85, north}, {9.55, north + 4.6}},
                                   {{9.7, north}, {14.4, north + 4.6}},
                                   {{7.3, south - 4.6}, {14.4, south}},
                                   {{0.0, south - 4.6}, {7.15, south}}};
  std::vector<Wall> hall_walls = walls_of(hall, random);
  layout.path = {{1.3, 1.3}};
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    const Room& room = rooms[i];
    const bool is_north = i < 3;
    std::vector<Wall> walls = walls_of(room, random);
    const double inwards = is_north ? 1.0 : -1.0;
    const Vector2d door(room.centre().x(), is_north ? north - kHalfWall : south + kHalfWall);
    add_opening(walls[is_north ? 2 : 0], door);
    add_opening(hall_walls[is_north ? 0 : 2], door);
    visit_room(layout, room, door, inwards);
    add_slab(layout, room, random);
    add_ceiling_lamps(layout, room, i < 3 ? 1 : 2, 2, random);
    furnish_room(layout, room, walls, true, random);
    if (i == 2) layout.path.push_back({13.1, 1.3});
  }
  for (Wall& wall : hall_walls) {
    std::sort(wall.openings.begin(), wall.openings.end(),
              [](const Opening& a, const Opening& b) { return a.begin < b.begin; });
  }
  add_slab(layout, hall, random);
  add_ceiling_lamps(layout, hall, 5, 1, random);
  furnish_room(layout, hall, hall_walls, false, random);
  layout.overlap = 3.0;
  return layout;
}

// One side of the corridor, cut into pieces of different make.
void add_corridor_side(Layout& layout, const Vector2d& from, const Vector2d& to, const Room& around,
                       Random& random) {
  const int pieces = std::max(1, static_cast<int>((to - from).norm() / 7.0));
  for (int i = 0; i < pieces; ++i) {
    Wall wall;
    wall.from = from + (to - from) * i / pieces;
    wall.to = from + (to - from) * (i + 1) / pieces;
    wall.pattern = wall_pattern(random);
    wall.variant = random.integer(2);
    wall.tint = soft_tint(random);
    FurnishOptions options;
    options.area_min = around.low;
    options.area_max = around.high;
    options.closed_doors = true;
    options.max_depth = 0.5;
    furnish_wall(layout, wall, options, random);
    layout.walls.push_back(wall);
  }
}

// A corridor around a rectangular block; its middle line is 212 m long.
Layout make_corridor(Random& random) {
  constexpr double kHalfWidth = 1.35;
  Layout layout;
  const Room middle{{0.0, 0.0}, {61.0, 45.0}};
  const Vector2d half = Vector2d::Constant(kHalfWidth);
  const Room outer{middle.low - half, middle.high + half},
      inner{middle.low + half, middle.high - half};
  const auto corners = [](const Room& r) {
    return std::vector<Vector2d>{{r.low.x(), r.high.y()}, r.high, {r.high.x(), r.low.y()}, r.low};
  };
  const auto out = corners(outer), in = corners(inner), mid = corners(middle);
  for (int i = 0; i < 4; ++i) {
    add_corridor_side(layout, out[i], out[(i + 1) % 4], outer, random);
    add_corridor_side(layout, in[(i + 1) % 4], in[i], outer, random);
  }
  for (int i = 0; i < 4; ++i) {
    const Vector2d from = mid[i], step = mid[(i + 1) % 4] - mid[i];
    const double length = step.norm();
    const int pieces = static_cast<int>(length / 7.5);
    for (int k = 0; k < pieces; ++k) {
      const Vector2d a = from + step * k / pieces, b = from + step * (k + 1) / pieces;
      const Vector2d along = step / length, side(-along.y(), along.x());
      Room piece{a.cwiseMin(b) - side.cwiseAbs() * kHalfWidth,
                 a.cwiseMax(b) + side.cwiseAbs() * kHalfWidth};
      if (k == 0) piece = {piece.low.cwiseMin(a - half), piece.high.cwiseMax(a + half)};
      if (k == pieces - 1) {  // the next side begins with the corner
        const Vector2d cut = along * kHalfWidth;
        if (cut.sum() > 0)
          piece.high -= cut;
        else
          piece.low -= cut;
      }
      add_slab(layout, piece, random);
      add_ceiling_lamps(layout, piece, along.x() != 0.0 ? 2 : 1, along.x() != 0.0 ? 1 : 2, random);
    }
    for (int k = 0; k < static_cast<int>(length); ++k) {
      const double s = k + 0.5;
      if (s > 1.2 && s < length - 1.2) layout.path.push_back(from + step * (s / length));
    }
  }
  // Start in the middle of a side, away from the corners.
  std::rotate(layout.path.begin(), layout.path.begin() + 30, layout.path.end());
  layout.overlap = 12.0;
  layout.natural_speed = 1.2;
  return layout;
}

}  // namespace

Vector2d Placement::axis_x() const { return {std::cos(yaw), std::sin(yaw)}; }
Vector2d Placement::axis_y() const { return {-std::sin(yaw), std::cos(yaw)}; }

void Placement::footprint(Vector2d& low, Vector2d& high) const {
  low = high = position + axis_x() * (width / 2);
  for (const double x : {-width / 2, width / 2}) {
    for (const double y : {-depth, 0.0}) {
      const Vector2d corner = position + axis_x() * x + axis_y() * y;
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  }
}

bool keeps_off_path(const Layout& layout, const Placement& placement, double margin) {
  Vector2d low, high;
  placement.footprint(low, high);
  const std::size_t n = layout.path.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d &a = layout.path[i], &b = layout.path[(i + 1) % n];
    const int steps = 1 + static_cast<int>((b - a).norm() / 0.1);
    for (int k = 0; k <= steps; ++k) {
      const Vector2d p = a + (b - a) * k / steps;
      if ((p - p.cwiseMax(low).cwiseMin(high)).norm() < margin) return false;
    }
  }
  return true;
}

const std::vector<std::string>& scene_names() {
  static const std::vector<std::string> names = {"room", "office", "corridor"};
  return names;
}

Layout make_layout(const std::string& scene, std::uint64_t seed) {
  Random random(mix_seed(seed, 0x5CE4E));
  if (scene == "room") return make_room(random);
  if (scene == "office") return make_office(random);
  if (scene == "corridor") return make_corridor(random);
  throw InputError("unknown scene '" + scene + "', expected room, office or corridor");
}

}  // namespace dxslam
