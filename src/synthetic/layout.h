// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "synthetic/patterns.h"
#include "synthetic/world.h"

namespace dxslam {

// A layout is the plan from which a world is built: walls, floors, lamps, the path to walk and a
// list of things. Factors that change a place between two visits edit the list, nothing else.

enum class ObjectKind {
  // on the floor
  kDesk,
  kTable,
  kChair,
  kBookshelf,
  kCabinet,
  kSofa,
  kCartons,
  kPlant,
  kBench,
  kRug,
  // on a wall
  kPoster,
  kPainting,
  kNoticeBoard,
  kClock,
  kDoor,
  kWindow,
};

/// One thing. Its own frame: x to the right and y to the back as seen from its front, origin at
/// the middle of its back edge on the floor; for things on a wall the back is the wall.
struct Placement {
  ObjectKind kind = ObjectKind::kTable;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< metres, of the origin
  double yaw = 0.0;                                    ///< radians, of the x axis
  double width = 1.0, depth = 1.0, height = 1.0;       ///< metres
  double base = 0.0;                                   ///< metres above the floor
  std::uint64_t seed = 0;                              ///< its look
  bool on_wall = false;
  bool fixed = false;  ///< part of the building (doors, windows)
  /// The wall piece (things on walls) or floor area (others) within which it may be moved.
  Eigen::Vector2d area_min = Eigen::Vector2d::Zero();
  Eigen::Vector2d area_max = Eigen::Vector2d::Zero();

  Eigen::Vector2d axis_x() const;
  Eigen::Vector2d axis_y() const;  ///< towards its back
  /// Smallest upright rectangle around its footprint on the floor.
  void footprint(Eigen::Vector2d& low, Eigen::Vector2d& high) const;
};

struct Opening {
  double begin = 0.0, end = 0.0;  ///< metres along the wall
};

/// Upright wall; seen from the front, it goes from left to right.
struct Wall {
  Eigen::Vector2d from, to;
  std::vector<Opening> openings;
  Pattern pattern = Pattern::kPlaster;
  int variant = 0;
  Eigen::Vector3f tint{1.0F, 1.0F, 1.0F};

  Eigen::Vector2d direction() const { return (to - from).normalized(); }
  double length() const { return (to - from).norm(); }
};

/// Upright rectangle of floor with its ceiling.
struct Slab {
  Eigen::Vector2d low, high;
  Pattern floor = Pattern::kPlanks;
  int floor_variant = 0;
  int ceiling_variant = 0;
};

struct Layout {
  double height = 2.7;  ///< metres, of the rooms
  std::vector<Wall> walls;
  std::vector<Slab> slabs;
  std::vector<Placement> placements;
  std::vector<Lamp> lamps;
  Eigen::Vector3f ambient{0.3F, 0.3F, 0.3F};  ///< BGR light from everywhere
  double brightness = 0.16;                   ///< linear mean of the pictures; 1 saturates
  /// Control points of the closed path, metres on the floor.
  std::vector<Eigen::Vector2d> path;
  double overlap = 1.0;        ///< metres walked again after the loop is closed
  double side_look = 0.0;      ///< radians, how far the camera looks to the left of the path
  double natural_speed = 0.5;  ///< metres per second
};

/// The names of the scenes: room, office, corridor.
const std::vector<std::string>& scene_names();

/// The plan of a scene. Throws InputError for an unknown name.
Layout make_layout(const std::string& scene, std::uint64_t seed);

/// True if the thing (not one on a wall) keeps `margin` metres from the path.
bool keeps_off_path(const Layout& layout, const Placement& placement, double margin);

}  // namespace dxslam
