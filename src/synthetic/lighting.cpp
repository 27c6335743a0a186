// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/lighting.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "synthetic/random.h"

namespace dxslam {
namespace {

using Box = Eigen::AlignedBox3d;

constexpr double kReach = 7.0;         // metres; a lamp fades to nothing there
constexpr double kNodeSpacing = 0.3;   // metres between nodes of a light grid
constexpr double kAmbientReach = 0.7;  // metres; farther things do not dim ambient light
constexpr int kAmbientRays = 8;

Box bounds_of(const Surface& s) {
  Box box(s.corner);
  box.extend(s.corner + s.edge_u);
  box.extend(s.corner + s.edge_v);
  box.extend(s.corner + s.edge_u + s.edge_v);
  return box;
}

/// Depends on where the surface is alone, so that its light stays the same whatever else changes.
std::uint64_t place_seed(const Surface& s) {
  const Eigen::Vector3d c = s.centre() * 1000.0;
  return mix_seed(mix_seed(static_cast<std::uint64_t>(std::llround(c.x())),
                           static_cast<std::uint64_t>(std::llround(c.y()))),
                  static_cast<std::uint64_t>(std::llround(c.z())));
}

/// True if the rectangle lies between the two points.
bool blocks(const Surface& s, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d normal = s.edge_u.cross(s.edge_v);
  const double a = normal.dot(from - s.corner), b = normal.dot(to - s.corner);
  if (a * b >= 0.0) return false;
  const Eigen::Vector3d hit = from + (to - from) * (a / (a - b)) - s.corner;
  const double u = hit.dot(s.edge_u), v = hit.dot(s.edge_v);
  return u >= 0.0 && v >= 0.0 && u <= s.edge_u.squaredNorm() && v <= s.edge_v.squaredNorm();
}

bool any_blocks(const std::vector<const Surface*>& blockers, const Eigen::Vector3d& from,
                const Eigen::Vector3d& to) {
  return std::any_of(blockers.begin(), blockers.end(),
                     [&](const Surface* s) { return blocks(*s, from, to); });
}

/// Light of an unshadowed lamp on a surface element.
Eigen::Vector3f lamp_light(const Lamp& lamp, const Eigen::Vector3d& point,
                           const Eigen::Vector3d& normal) {
  const Eigen::Vector3d to_lamp = lamp.position - point;
  const double distance = to_lamp.norm();
  if (distance >= kReach || distance < 1e-6) return Eigen::Vector3f::Zero();
  const double on_surface = std::max(0.0, normal.dot(to_lamp) / distance);
  const double from_lamp = std::max(0.0, -lamp.direction.dot(to_lamp) / distance);
  const double fade = 1.0 - std::pow(distance / kReach, 4.0);
  const double power = on_surface * (0.25 + 0.75 * from_lamp) * fade / (distance * distance + 0.4);
  return lamp.color * static_cast<float>(power);
}

struct LampBlockers {
  const Lamp* lamp;
  std::vector<const Surface*> surfaces;
};

class Baker {
 public:
  explicit Baker(World& world) : world_(world) {
    for (const Surface& s : world.surfaces) bounds_.push_back(bounds_of(s));
    for (const Lamp& lamp : world.lamps) {
      near_lamp_.emplace_back();
      for (std::size_t i = 0; i < bounds_.size(); ++i) {
        if (bounds_[i].exteriorDistance(lamp.position) < kReach) near_lamp_.back().push_back(i);
      }
    }
  }

  void bake(Surface& s, const Box& bounds, std::uint64_t seed) const {
    const std::vector<LampBlockers> lamps = lamps_for(s, bounds);
    const std::vector<const Surface*> around = surfaces_near(s, bounds);
    LightGrid& grid = s.light;
    grid.columns = std::clamp(static_cast<int>(s.edge_u.norm() / kNodeSpacing) + 2, 2, 64);
    grid.rows = std::clamp(static_cast<int>(s.edge_v.norm() / kNodeSpacing) + 2, 2, 64);
    grid.nodes.clear();
    Random random(seed);
    const double inset_u = std::min(0.25, 0.02 / s.edge_u.norm());
    const double inset_v = std::min(0.25, 0.02 / s.edge_v.norm());
    for (int row = 0; row < grid.rows; ++row) {
      for (int col = 0; col < grid.columns; ++col) {
        const double u = std::clamp(col / (grid.columns - 1.0), inset_u, 1.0 - inset_u);
        const double v = std::clamp(row / (grid.rows - 1.0), inset_v, 1.0 - inset_v);
        const Eigen::Vector3d point = s.corner + u * s.edge_u + v * s.edge_v + 0.004 * s.normal();
        grid.nodes.push_back(
            light_at(point, s.normal(), lamps, around, random).cwiseProduct(s.tint));
      }
    }
  }

  void bake_all(int threads) {
    in_parallel(world_.surfaces.size(), threads, [&](std::size_t i) {
      Surface& s = world_.surfaces[i];
      if (s.emission > 0.0F) {
        s.light = {2, 2, std::vector<Eigen::Vector3f>(4, s.tint * s.emission)};
      } else {
        bake(s, bounds_[i], place_seed(s));
      }
    });
  }

 private:
  std::vector<LampBlockers> lamps_for(const Surface& s, const Box& bounds) const {
    std::vector<LampBlockers> result;
    for (std::size_t k = 0; k < world_.lamps.size(); ++k) {
      const Lamp& lamp = world_.lamps[k];
      if (bounds.exteriorDistance(lamp.position) >= kReach) continue;
      if (s.normal().dot(lamp.position - s.corner) <= 0.0) continue;
      Box between = bounds;
      between.extend(lamp.position);
      LampBlockers entry{&lamp, {}};
      for (const std::size_t i : near_lamp_[k]) {
        const Surface& other = world_.surfaces[i];
        if (&other != &s && other.emission <= 0.0F && between.intersects(bounds_[i])) {
          entry.surfaces.push_back(&other);
        }
      }
      result.push_back(std::move(entry));
    }
    return result;
  }

  std::vector<const Surface*> surfaces_near(const Surface& s, const Box& bounds) const {
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(kAmbientReach);
    const Box wide(bounds.min() - margin, bounds.max() + margin);
    std::vector<const Surface*> result;
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
      if (wide.intersects(bounds_[i]) && &world_.surfaces[i] != &s) {
        result.push_back(&world_.surfaces[i]);
      }
    }
    return result;
  }

  Eigen::Vector3f light_at(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                           const std::vector<LampBlockers>& lamps,
                           const std::vector<const Surface*>& around, Random& random) const {
    int open = 0;
    for (int ray = 0; ray < kAmbientRays; ++ray) {
      Eigen::Vector3d direction(random.normal(), random.normal(), random.normal());
      direction = (direction.normalized() + 1.02 * normal).normalized();
      open += !any_blocks(around, point, point + kAmbientReach * direction);
    }
    Eigen::Vector3f light =
        world_.ambient * (0.35F + 0.65F * static_cast<float>(open) / kAmbientRays);
    for (const LampBlockers& entry : lamps) {
      const Eigen::Vector3f full = lamp_light(*entry.lamp, point, normal);
      if (full.maxCoeff() < 1e-3F) continue;
      int seen = 0;
      for (int corner = 0; corner < 3; ++corner) {
        const double angle = 2.0944 * corner + 0.5;
        const Eigen::Vector3d side = entry.lamp->direction.unitOrthogonal();
        const Eigen::Vector3d other = entry.lamp->direction.cross(side);
        const Eigen::Vector3d source =
            entry.lamp->position + entry.lamp->direction * 0.02 +
            entry.lamp->half_size * (std::cos(angle) * side + std::sin(angle) * other);
        seen += !any_blocks(entry.surfaces, point, source);
      }
      light += full * (static_cast<float>(seen) / 3.0F);
    }
    return light;
  }

  World& world_;
  std::vector<Box> bounds_;
  std::vector<std::vector<std::size_t>> near_lamp_;
};

}  // namespace

void bake_light(World& world, int threads) { Baker(world).bake_all(threads); }

void light_without_shadows(const World& world, std::vector<Surface>& surfaces) {
  for (Surface& s : surfaces) {
    s.light = {2, 2, {}};
    for (int corner = 0; corner < 4; ++corner) {
      const Eigen::Vector3d point = s.corner + (corner & 1) * s.edge_u + (corner >> 1) * s.edge_v;
      Eigen::Vector3f light = world.ambient * 0.8F;
      for (const Lamp& lamp : world.lamps) light += lamp_light(lamp, point, s.normal());
      s.light.nodes.push_back(light.cwiseProduct(s.tint));
    }
  }
}

void expose_for(World& world, double level) {
  double sum = 0.0, area = 0.0;
  for (const Surface& s : world.surfaces) {
    if (s.emission > 0.0F || s.object >= 0) continue;
    const cv::Vec3f mean = world.textures[s.texture].mean();
    const double albedo = std::pow((mean[0] + mean[1] + mean[2]) / 765.0, 2.2);
    double light = 0.0;
    for (const Eigen::Vector3f& node : s.light.nodes) light += node.mean();
    const double weight = s.edge_u.norm() * s.edge_v.norm();
    sum += weight * albedo * light / static_cast<double>(s.light.nodes.size());
    area += weight;
  }
  if (sum > 0.0) world.exposure = static_cast<float>(level * area / sum);
}

}  // namespace dxslam
