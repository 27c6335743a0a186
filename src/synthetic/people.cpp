// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/people.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "synthetic/lighting.h"
#include "synthetic/patterns.h"
#include "synthetic/random.h"
#include "synthetic/renderer.h"

namespace dxslam {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kWardrobe = 6;    // different shirts, trousers and faces
constexpr double kVisit = 3.0;  // seconds that a walk stays in view, about

// Free depth straight ahead, metres, by a coarse look.
double depth_ahead(const World& world, const SE3& world_from_camera) {
  Camera coarse;
  coarse.width = 32;
  coarse.height = 16;
  coarse.fx = coarse.fy = 26.0;
  coarse.cx = 15.5;
  coarse.cy = 7.5;
  RenderOptions options;
  options.antialias = false;
  const cv::Mat depth = render(world, {}, coarse, world_from_camera, options).depth;
  float nearest = 1e3F;
  for (int x = 10; x < 22; ++x) nearest = std::min(nearest, depth.at<float>(6, x));
  return nearest;
}

// Closed prism from a (upper end) to b; the middle of the picture faces `front`.
void add_limb(std::vector<Surface>& out, const Vector3d& a, const Vector3d& b, double radius,
              int sides, int texture, const Vector3d& front) {
  const Vector3d axis = (a - b).normalized();
  const Vector3d back = -(front - axis * axis.dot(front)).normalized();
  const Vector3d side = axis.cross(back);
  const auto around = [&](int i) {
    const double angle = 2.0 * 3.14159265358979 * i / sides;
    return Vector3d(radius * (std::cos(angle) * back + std::sin(angle) * side));
  };
  Surface s;
  s.texture = texture;
  for (int i = 0; i < sides; ++i) {
    s.corner = a + around(i);
    s.edge_u = around(i + 1) - around(i);
    s.edge_v = b - a;
    s.repeat = {1.0F / static_cast<float>(sides), 1.0F};
    s.offset = {static_cast<float>(i) / static_cast<float>(sides), 0.0F};
    out.push_back(s);
  }
  const Vector3d u = 1.3 * radius * side, v = 1.3 * radius * back;
  s.repeat = {0.2F, 0.2F};
  s.corner = a - 0.5 * u + 0.5 * v;
  s.edge_u = u;
  s.edge_v = -v;
  out.push_back(s);
}

}  // namespace

People::People(World& world, const CameraPath& path, double density, std::uint64_t seed) {
  if (density <= 0.0) return;
  const int first = static_cast<int>(world.textures.size());
  for (int i = 0; i < kWardrobe; ++i) {
    const std::uint64_t look = mix_seed(seed, 77 + static_cast<std::uint64_t>(i));
    world.textures.emplace_back(paint_pattern(Pattern::kClothes, look, {512, 256}));
    world.textures.emplace_back(paint_pattern(Pattern::kClothes, look + 1, {256, 256}));
    world.textures.emplace_back(paint_pattern(Pattern::kFace, look, {256, 128}));
  }
  Random random(mix_seed(seed, 0x9E091E));
  double time = random.uniform(0.8, 1.6);
  while (time < path.duration()) {
    const SE3 camera = path.world_from_camera(time);
    const double room = depth_ahead(world, camera) - 0.4;
    const double distance = std::min(random.uniform(1.3, 3.0), room);
    if (distance < 0.8) {
      time += 0.5;
      continue;
    }
    const Vector3d forward = camera.rotation() * Vector3d::UnitZ();
    const Vector2d ahead = forward.head<2>().normalized(), right(ahead.y(), -ahead.x());
    Walk walk;
    walk.time = time;
    walk.speed = random.uniform(0.7, 1.2);
    walk.size = random.uniform(0.92, 1.08);
    const double sign = random.chance(0.5) ? 1.0 : -1.0;
    if (room > 4.0 && random.chance(0.4)) {  // comes towards the camera and passes it
      walk.middle = camera.translation().head<2>() + 2.5 * ahead + 0.6 * sign * right;
      walk.direction = -ahead;
      walk.reach = 5.0;
    } else {
      walk.middle = camera.translation().head<2>() + distance * ahead;
      walk.direction = (sign * right + random.uniform(-0.5, 0.5) * ahead).normalized();
    }
    walk.shirt = first + 3 * random.integer(kWardrobe);
    walk.trousers = first + 3 * random.integer(kWardrobe) + 1;
    walk.face = first + 3 * random.integer(kWardrobe) + 2;
    walks_.push_back(walk);
    time += kVisit / density * random.uniform(0.7, 1.3);
  }
}

std::vector<Surface> People::surfaces_at(const World& world, double time) const {
  std::vector<Surface> out;
  for (const Walk& w : walks_) {
    const double along = w.speed * (time - w.time);
    if (std::abs(along) > w.reach) continue;
    const Vector2d floor = w.middle + w.direction * along;
    const Vector3d front(w.direction.x(), w.direction.y(), 0.0), side(-front.y(), front.x(), 0.0);
    const auto at = [&](double right, double ahead, double up) {
      return Vector3d(Vector3d(floor.x(), floor.y(), 0.0) +
                      w.size * (front * ahead - side * right + Vector3d(0, 0, up)));
    };
    const double swing = std::sin(along / w.size * 4.2);
    add_limb(out, at(0, 0, 1.46), at(0, 0, 0.86), 0.19 * w.size, 10, w.shirt, front);
    add_limb(out, at(0, 0.02, 1.76), at(0, 0, 1.46), 0.105 * w.size, 8, w.face, front);
    for (const double right : {-1.0, 1.0}) {
      const double step = right * swing;
      add_limb(out, at(0.1 * right, 0, 0.88), at(0.1 * right, 0.28 * step, 0.04), 0.085 * w.size, 6,
               w.trousers, front);
      add_limb(out, at(0.24 * right, 0, 1.42), at(0.26 * right, -0.22 * step, 0.8), 0.055 * w.size,
               6, w.shirt, front);
    }
  }
  light_without_shadows(world, out);
  return out;
}

}  // namespace dxslam
