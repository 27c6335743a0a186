// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <Eigen/Core>
#include <vector>

#include "synthetic/texture.h"

namespace dxslam {

// The world frame is x and y along the floor, z up, metres. All that can be seen is a textured
// rectangle: rooms are shells of them, furniture is boxes of them.

/// Light that falls on a surface (BGR, linear), at the nodes of a regular grid that includes the
/// borders; the tint of the surface is already in it.
struct LightGrid {
  int columns = 0;                     ///< along edge_u
  int rows = 0;                        ///< along edge_v
  std::vector<Eigen::Vector3f> nodes;  ///< row by row
};

/// One-sided rectangle, visible from where edge_u points right and edge_v down.
struct Surface {
  Eigen::Vector3d corner = Eigen::Vector3d::Zero();  ///< top left
  Eigen::Vector3d edge_u = Eigen::Vector3d::UnitX();
  Eigen::Vector3d edge_v = Eigen::Vector3d::UnitY();  ///< orthogonal to edge_u
  int texture = 0;                                    ///< index into World::textures
  Eigen::Vector2f repeat{1.0F, 1.0F};                 ///< pictures along edge_u and edge_v
  Eigen::Vector2f offset{0.0F, 0.0F};                 ///< pictures
  bool tiled = false;                                 ///< wrap around instead of clamping
  Eigen::Vector3f tint{1.0F, 1.0F, 1.0F};             ///< BGR factor on the texture
  float emission = 0.0F;  ///< > 0: shines by itself with this light and ignores lamps
  int object = -1;        ///< index of the placement it belongs to; -1: the building itself
  LightGrid light;

  /// Unit vector that points to the visible side.
  Eigen::Vector3d normal() const { return edge_v.cross(edge_u).normalized(); }
  Eigen::Vector3d centre() const { return corner + 0.5 * (edge_u + edge_v); }
};

/// Rectangular lamp that shines to one side with a cosine falloff.
struct Lamp {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = -Eigen::Vector3d::UnitZ();  ///< unit, where it shines
  double half_size = 0.3;                                 ///< metres, softens its shadows
  Eigen::Vector3f color{1.0F, 1.0F, 1.0F};                ///< BGR power
};

/// Everything a renderer needs. Plain data; safe to share between threads while nobody writes.
struct World {
  std::vector<Surface> surfaces;
  std::vector<Texture> textures;
  std::vector<Lamp> lamps;
  Eigen::Vector3f ambient{0.3F, 0.3F, 0.3F};  ///< BGR light from everywhere
  float exposure = 1.0F;                      ///< linear factor from radiance to sensor value
};

}  // namespace dxslam
