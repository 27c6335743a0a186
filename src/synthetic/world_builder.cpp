// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/world_builder.h"

#include <algorithm>
#include <cmath>

#include "synthetic/furniture.h"
#include "synthetic/lighting.h"
#include "synthetic/random.h"
#include "synthetic/surface_builder.h"

namespace dxslam {
namespace {

using Eigen::Vector3d;

constexpr double kDoorHeight = 2.1;
constexpr double kHalfWall = 0.075;
constexpr double kLongestPiece = 4.0;  // metres of wall in one surface
constexpr double kSeam = 0.003;        // metres that pieces of wall overlap, against gaps

// In the frame of the wall (x along it, y into it) from x = begin to end, z = low to high.
void add_wall_piece(SurfaceBuilder& builder, double begin, double end, double low, double high,
                    const Skin& skin) {
  const int parts = std::max(1, static_cast<int>(std::ceil((end - begin) / kLongestPiece)));
  for (int i = 0; i < parts; ++i) {
    const double a = begin + (end - begin) * i / parts - kSeam;
    const double b = begin + (end - begin) * (i + 1) / parts + kSeam;
    builder.add_quad({a, 0, high + kSeam}, {b - a, 0, 0}, {0, 0, low - high - 2 * kSeam}, skin);
    // A wall's material goes on across its pieces.
    Surface& surface = builder.surfaces().back();
    surface.offset = {static_cast<float>(std::fmod(a, kMaterialSize) / kMaterialSize + 1.0),
                      static_cast<float>((2.7 - high) / kMaterialSize)};
  }
}

void build_wall(SurfaceBuilder& builder, const Wall& wall, double height, std::uint64_t seed) {
  const double yaw = std::atan2(wall.direction().y(), wall.direction().x());
  builder.set_frame({wall.from.x(), wall.from.y(), 0.0}, yaw, -1, seed);
  Skin skin = builder.material(wall.pattern, wall.variant);
  skin.tint = wall.tint;
  const Skin jamb = builder.material(Pattern::kWood, 0);
  double s = 0.0;
  for (const Opening& opening : wall.openings) {
    add_wall_piece(builder, s, opening.begin, 0.0, height, skin);
    add_wall_piece(builder, opening.begin, opening.end, kDoorHeight, height, skin);
    const Vector3d down(0, 0, -kDoorHeight), in(0, kHalfWall + kSeam, 0);
    builder.add_quad({opening.begin, 0, kDoorHeight}, in, down, jamb);
    builder.add_quad({opening.end, kHalfWall + kSeam, kDoorHeight}, -in, down, jamb);
    builder.add_quad({opening.begin, 0, kDoorHeight}, {opening.end - opening.begin, 0, 0}, in,
                     jamb);
    s = opening.end;
  }
  add_wall_piece(builder, s, wall.length(), 0.0, height, skin);
  const Skin skirting = builder.material(Pattern::kWood, 1);
  s = 0.0;
  for (std::size_t i = 0; i <= wall.openings.size(); ++i) {
    const double end = i < wall.openings.size() ? wall.openings[i].begin : wall.length();
    builder.add_quad({s, -0.012, 0.09}, {end - s, 0, 0}, {0, 0, -0.09}, skirting);
    builder.add_quad({s, 0, 0.09}, {end - s, 0, 0}, {0, -0.012, 0}, skirting);
    if (i < wall.openings.size()) s = wall.openings[i].end;
  }
}

void build_slab(SurfaceBuilder& builder, const Slab& slab, double height, std::uint64_t seed) {
  builder.set_frame(Vector3d::Zero(), 0.0, -1, seed);
  const Eigen::Vector2d size = slab.high - slab.low;
  builder.add_quad({slab.low.x(), slab.high.y(), 0.0}, {size.x(), 0, 0}, {0, -size.y(), 0},
                   builder.material(slab.floor, slab.floor_variant));
  builder.add_quad({slab.low.x(), slab.low.y(), height}, {size.x(), 0, 0}, {0, size.y(), 0},
                   builder.material(Pattern::kCeiling, slab.ceiling_variant));
}

void build_lamp(SurfaceBuilder& builder, const Lamp& lamp, double height, std::uint64_t seed) {
  if (lamp.direction.z() > -0.9) return;  // light from outside has no fitting
  builder.set_frame({lamp.position.x(), lamp.position.y(), 0.0}, 0.0, -1, seed);
  Skin panel = builder.picture(Pattern::kLampPanel, 1, 128, 64);
  const Skin rim = builder.material(Pattern::kMetal, 0);
  const float brightness = lamp.color.mean() > 0.0F ? 4.0F : 0.5F;
  panel.emission = brightness;
  builder.add_box({-0.6, -0.15, height - 0.02}, {0.6, 0.15, height}, rim);
  builder.add_quad({-0.55, -0.13, height - 0.022}, {1.1, 0, 0}, {0, 0.26, 0}, panel);
}

}  // namespace

World build_world(const Layout& layout, std::uint64_t seed, int threads) {
  SurfaceBuilder builder;
  std::uint64_t part = 0;
  for (const Wall& wall : layout.walls) build_wall(builder, wall, layout.height, ++part);
  for (const Slab& slab : layout.slabs) build_slab(builder, slab, layout.height, ++part);
  for (const Lamp& lamp : layout.lamps) build_lamp(builder, lamp, layout.height, ++part);
  for (std::size_t i = 0; i < layout.placements.size(); ++i) {
    build_placement(builder, layout.placements[i], static_cast<int>(i));
  }
  World world;
  world.textures = builder.paint(seed, threads);
  world.surfaces = std::move(builder.surfaces());
  for (const Lamp& lamp : layout.lamps) {
    if (lamp.color.maxCoeff() > 0.0F) world.lamps.push_back(lamp);
  }
  world.ambient = layout.ambient;
  bake_light(world, threads);
  expose_for(world, layout.brightness);
  return world;
}

}  // namespace dxslam
