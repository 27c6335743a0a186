// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/surface_builder.h"

#include <cmath>

#include "core/parallel.h"
#include "synthetic/random.h"

namespace dxslam {

using Eigen::Vector3d;

void SurfaceBuilder::set_frame(const Vector3d& origin, double yaw, int object, std::uint64_t seed) {
  origin_ = origin;
  cos_ = std::cos(yaw);
  sin_ = std::sin(yaw);
  object_ = object;
  object_seed_ = seed;
  first_surface_ = surfaces_.size();
}

Skin SurfaceBuilder::picture(Pattern pattern, std::uint64_t seed, int width, int height) {
  const auto [entry, is_new] = known_.try_emplace({static_cast<int>(pattern), seed, false},
                                                  static_cast<int>(requests_.size()));
  if (is_new) requests_.push_back({pattern, seed, width, height});
  return {entry->second, false, {1.0F, 1.0F, 1.0F}, 0.0F};
}

Skin SurfaceBuilder::material(Pattern pattern, int variant) {
  constexpr int kSide = 1024;  // 2.5 mm a texel
  const auto [entry, is_new] =
      known_.try_emplace({static_cast<int>(pattern), static_cast<std::uint64_t>(variant), true},
                         static_cast<int>(requests_.size()));
  if (is_new) requests_.push_back({pattern, static_cast<std::uint64_t>(variant), kSide, kSide});
  return {entry->second, true, {1.0F, 1.0F, 1.0F}, 0.0F};
}

void SurfaceBuilder::add_quad(const Vector3d& corner, const Vector3d& edge_u,
                              const Vector3d& edge_v, const Skin& skin) {
  const auto turn = [this](const Vector3d& v) {
    return Vector3d(cos_ * v.x() - sin_ * v.y(), sin_ * v.x() + cos_ * v.y(), v.z());
  };
  Surface s;
  s.corner = origin_ + turn(corner);
  s.edge_u = turn(edge_u);
  s.edge_v = turn(edge_v);
  s.texture = skin.texture;
  s.tiled = skin.tiled;
  s.tint = skin.tint;
  s.emission = skin.emission;
  s.object = object_;
  if (skin.tiled) {
    s.repeat = Eigen::Vector2d(edge_u.norm(), edge_v.norm()).cast<float>() /
               static_cast<float>(kMaterialSize);
    // Every face shows another part of the material.
    Random random(mix_seed(surfaces_.size() - first_surface_, mix_seed(object_seed_, 0x0FF5E7)));
    s.offset = Eigen::Vector2d(random.uniform(), random.uniform()).cast<float>();
  }
  surfaces_.push_back(std::move(s));
}

void SurfaceBuilder::add_box(const Vector3d& low, const Vector3d& high, const Skin& skin) {
  add_box(low, high, skin, skin, skin);
}

void SurfaceBuilder::add_box(const Vector3d& low, const Vector3d& high, const Skin& skin,
                             const Skin& front, const Skin& top) {
  const Vector3d size = high - low;
  const Vector3d x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
  add_quad({low.x(), low.y(), high.z()}, x, -z, front);
  add_quad(high, -x, -z, skin);
  add_quad({high.x(), low.y(), high.z()}, y, -z, skin);
  add_quad({low.x(), high.y(), high.z()}, -y, -z, skin);
  add_quad({low.x(), high.y(), high.z()}, x, -y, top);
  if (low.z() > 0.05) add_quad(low, x, y, skin);
}

void SurfaceBuilder::add_column(double x, double y, double radius, double z_low, double z_high,
                                int sides, const Skin& skin) {
  const double step = 2.0 * 3.14159265358979 / sides;
  for (int i = 0; i < sides; ++i) {
    // Going round against the clock, the outside sees each face from left to right.
    const Vector3d a(x + radius * std::cos(i * step), y + radius * std::sin(i * step), z_high);
    const Vector3d b(x + radius * std::cos((i + 1) * step), y + radius * std::sin((i + 1) * step),
                     z_high);
    add_quad(a, b - a, {0, 0, z_low - z_high}, skin);
    if (skin.tiled) continue;
    // One picture around the whole column.
    surfaces_.back().repeat = {1.0F / static_cast<float>(sides), 1.0F};
    surfaces_.back().offset = {static_cast<float>(i) / static_cast<float>(sides), 0.0F};
  }
  const double half = radius * 0.7071;
  add_quad({x - half, y + half, z_high}, {2 * half, 0, 0}, {0, -2 * half, 0}, skin);
}

std::vector<Texture> SurfaceBuilder::paint(std::uint64_t seed, int threads) const {
  std::vector<Texture> textures(requests_.size());
  in_parallel(requests_.size(), threads, [&](std::size_t i) {
    const Request& r = requests_[i];
    textures[i] = Texture(paint_pattern(r.pattern, mix_seed(seed, r.seed), {r.width, r.height}));
  });
  return textures;
}

}  // namespace dxslam
