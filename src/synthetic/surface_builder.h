// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "synthetic/patterns.h"
#include "synthetic/world.h"

namespace dxslam {

/// What covers a face: a material that repeats at its natural scale, or one picture fitted to it.
struct Skin {
  int texture = 0;
  bool tiled = false;
  Eigen::Vector3f tint{1.0F, 1.0F, 1.0F};
  float emission = 0.0F;
};

/// Collects surfaces and the pictures they ask for. Shapes are given in the frame of the thing
/// being built (see Placement) and moved to the world.
class SurfaceBuilder {
 public:
  /// Things that follow are placed at `origin`, turned by `yaw` about z, and belong to `object`.
  /// `seed` picks the parts of the materials that they show.
  void set_frame(const Eigen::Vector3d& origin, double yaw, int object, std::uint64_t seed);

  /// A picture of its own, or the shared material number `variant`.
  Skin picture(Pattern pattern, std::uint64_t seed, int width, int height);
  Skin material(Pattern pattern, int variant);

  /// Rectangle seen from where edge_u points right and edge_v down.
  void add_quad(const Eigen::Vector3d& corner, const Eigen::Vector3d& edge_u,
                const Eigen::Vector3d& edge_v, const Skin& skin);
  /// Box with outward faces: `front` (towards -y) may have a skin of its own.
  void add_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const Skin& skin);
  void add_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const Skin& skin,
               const Skin& front, const Skin& top);
  /// Upright prism with `sides` faces around an axis at (x, y).
  void add_column(double x, double y, double radius, double z_low, double z_high, int sides,
                  const Skin& skin);

  std::vector<Surface>& surfaces() { return surfaces_; }
  /// Paints all pictures asked for, in parallel; index i belongs to Surface::texture == i.
  std::vector<Texture> paint(std::uint64_t seed, int threads) const;

 private:
  struct Request {
    Pattern pattern;
    std::uint64_t seed;
    int width, height;
  };
  std::vector<Surface> surfaces_;
  std::vector<Request> requests_;
  std::map<std::tuple<int, std::uint64_t, bool>, int> known_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  double cos_ = 1.0, sin_ = 0.0;
  int object_ = -1;
  std::uint64_t object_seed_ = 0;
  std::size_t first_surface_ = 0;  // of the present thing
};

}  // namespace dxslam
