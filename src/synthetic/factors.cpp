// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/factors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "io/primitives/text_file.h"
#include "synthetic/low_light.h"
#include "synthetic/random.h"

namespace dxslam {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3f;

// One stream of random numbers for each factor.
Random stream(const FactorOptions& factors, std::uint64_t factor) {
  return Random(mix_seed(static_cast<std::uint64_t>(factors.seed), factor));
}

Vector3f colored(Random& random, double strength) {
  const double warmth = random.uniform(-1.0, 1.0) * strength;  // > 0: redder
  return Eigen::Vector3d(std::exp(-0.6 * warmth), std::exp(-0.1 * warmth), std::exp(0.3 * warmth))
      .cast<float>();
}

void change_illumination(Layout& layout, const FactorOptions& factors) {
  Random random = stream(factors, 1);
  const double strength = factors.illumination;
  const std::vector<Lamp> lamps = layout.lamps;
  const Vector3f common = colored(random, strength);
  for (Lamp& lamp : layout.lamps) {
    const bool off = random.chance(0.55 * strength);
    const double power = off ? 0.0 : std::exp(1.2 * strength * random.uniform(-1.0, 1.0));
    lamp.color = lamp.color.cwiseProduct(common).cwiseProduct(colored(random, 0.6 * strength)) *
                 static_cast<float>(power);
  }
  // Standing lamps and daylight from the side, one for every three of the ceiling.
  for (std::size_t i = 0; i < lamps.size(); i += 3) {
    const double angle = random.uniform(0.0, 6.28318);
    Lamp side = lamps[i];
    side.direction = Eigen::Vector3d(std::cos(angle), std::sin(angle), -0.35).normalized();
    side.position.z() = 1.9;
    side.position.head<2>() -= 0.9 * side.direction.head<2>();
    side.color = colored(random, strength) * static_cast<float>(7.0 * strength);
    layout.lamps.push_back(side);
  }
  layout.ambient = layout.ambient.cwiseProduct(colored(random, strength)) *
                   static_cast<float>(std::exp(strength * random.uniform(-0.7, 0.1)));
  layout.brightness *= std::exp(0.5 * strength * random.uniform(-1.0, 1.0));
}

bool free_for(const Layout& layout, const Placement& p, std::size_t self) {
  Vector2d low, high, other_low, other_high;
  p.footprint(low, high);
  if ((low.array() < p.area_min.array() - 0.02).any()) return false;
  if ((high.array() > p.area_max.array() + 0.02).any()) return false;
  if (p.on_wall || p.kind == ObjectKind::kRug) return true;
  for (std::size_t i = 0; i < layout.placements.size(); ++i) {
    const Placement& q = layout.placements[i];
    if (i == self || q.on_wall || q.kind == ObjectKind::kRug) continue;
    q.footprint(other_low, other_high);
    if ((low.array() < other_high.array()).all() && (other_low.array() < high.array()).all()) {
      return false;
    }
  }
  return keeps_off_path(layout, p, 0.45);
}

// False if no free place was found.
bool move_thing(const Layout& layout, Placement& p, std::size_t self, Random& random) {
  for (int trial = 0; trial < 24; ++trial) {
    Placement moved = p;
    const double along = random.uniform(0.15, 0.7) * (random.chance(0.5) ? 1.0 : -1.0);
    moved.position += moved.axis_x() * along;
    if (p.on_wall) {
      moved.base =
          std::clamp(p.base + random.uniform(-0.15, 0.15), 0.9, layout.height - p.height - 0.1);
    } else {
      moved.position -= moved.axis_y() * random.uniform(0.0, 0.2);
      moved.yaw += random.uniform(-0.2, 0.2);
    }
    if (!free_for(layout, moved, self)) continue;
    p = moved;
    return true;
  }
  return false;
}

void change_objects(Layout& layout, const FactorOptions& factors) {
  Random random = stream(factors, 2);
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i < layout.placements.size(); ++i) {
    if (!layout.placements[i].fixed) candidates.push_back(i);
  }
  for (std::size_t i = candidates.size(); i > 1; --i) {
    std::swap(candidates[i - 1], candidates[random.integer(static_cast<int>(i))]);
  }
  candidates.resize(static_cast<std::size_t>(
      std::lround(factors.changed_objects * static_cast<double>(candidates.size()))));
  std::vector<std::size_t> removed;
  for (const std::size_t i : candidates) {
    Placement& p = layout.placements[i];
    const double pick = random.uniform();
    if (pick < 0.3) {
      removed.push_back(i);
    } else if (pick < 0.6 || !move_thing(layout, p, i, random)) {
      p.seed = random.bits();
      if (p.kind == ObjectKind::kPoster)
        p.kind = random.chance(0.5) ? p.kind : ObjectKind::kPainting;
    }
  }
  std::sort(removed.rbegin(), removed.rend());
  for (const std::size_t i : removed) {
    layout.placements.erase(layout.placements.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

}  // namespace

PathOptions path_with_factors(PathOptions path, const FactorOptions& factors) {
  path.sideways = std::clamp(path.sideways + 0.35 * factors.viewpoint, -0.4, 0.4);
  path.raise += 0.2 * factors.viewpoint;
  path.turn += 15.0 * factors.viewpoint;
  return path;
}

void apply_factors(Layout& layout, const FactorOptions& factors) {
  if (factors.illumination > 0.0) change_illumination(layout, factors);
  if (factors.changed_objects > 0.0) change_objects(layout, factors);
}

double exposure_gain(const FactorOptions& factors, double time) {
  if (factors.exposure_drift == 0.0) return 1.0;
  Random random = stream(factors, 3);
  const double slow = std::sin(0.75 * time + random.uniform(0.0, 6.28));
  const double quick = std::sin(2.3 * time + random.uniform(0.0, 6.28));
  return std::exp(0.41 * factors.exposure_drift * (0.75 * slow + 0.25 * quick));
}

const std::vector<FactorName>& factor_names() {
  static const std::vector<FactorName> names = {
      {"viewpoint", &FactorOptions::viewpoint, 1.0, "share of 0.35 m aside, 0.2 m up and 15 deg"},
      {"illumination", &FactorOptions::illumination, 0.7, "0 to 1"},
      {"low_light", &FactorOptions::low_light, LowLight::kDefaultGain, "gain"},
      {"changed_objects", &FactorOptions::changed_objects, 0.3, "share of the things"},
      {"people", &FactorOptions::people, 0.7, "persons in view"},
      {"exposure_drift", &FactorOptions::exposure_drift, 1.0, "1: +-50 %"},
      {"motion_blur", &FactorOptions::motion_blur, 1.0, "exposure time over 20 ms"},
      {"image_noise", &FactorOptions::image_noise, 2.0, "1: 1.5 grey levels; on by default"},
      {"depth_noise", &FactorOptions::depth_noise, 2.0, "1: structured light; on by default"},
  };
  return names;
}

void set_factor(FactorOptions& factors, const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  std::vector<std::string> known;
  for (const FactorName& factor : factor_names()) {
    known.emplace_back(factor.name);
    if (name != factor.name) continue;
    double strength = factor.usual;
    if (equals != std::string::npos) {
      const auto number = parse_number(text.substr(equals + 1));
      if (!number)
        throw InputError(
            fmt::format("factor {} has a strength that is no number", in_quotes(text)));
      strength = *number;
    }
    factors.*factor.strength = strength;
    validate_options("factors", factors);
    return;
  }
  throw InputError(fmt::format("unknown factor {}, expected one of {}", in_quotes(name),
                               fmt::join(known, ", ")));
}

}  // namespace dxslam
