// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/furnish.h"

#include <algorithm>
#include <cmath>

namespace dxslam {
namespace {

using Eigen::Vector2d;

constexpr double kPathMargin = 0.5;  // metres between furniture and the path

struct Span {
  double begin, end;
  double top;  // height up to which it hides the wall, metres
};

double top_over(const std::vector<Span>& spans, double begin, double end) {
  double top = 0.0;
  for (const Span& span : spans) {
    if (span.begin < end && span.end > begin) top = std::max(top, span.top);
  }
  return top;
}

Placement at_wall(const Wall& wall, double s, double width, const FurnishOptions& options,
                  Random& random) {
  Placement p;
  p.position = wall.from + wall.direction() * s;
  p.yaw = std::atan2(wall.direction().y(), wall.direction().x());
  p.width = width;
  p.seed = random.bits();
  p.area_min = options.area_min;
  p.area_max = options.area_max;
  return p;
}

// Kind and size of the next thing along the wall.
void choose_furniture(Placement& p, const FurnishOptions& options, Random& random) {
  static constexpr ObjectKind kDeep[] = {
      ObjectKind::kDesk,    ObjectKind::kBookshelf, ObjectKind::kCabinet,   ObjectKind::kSofa,
      ObjectKind::kCartons, ObjectKind::kPlant,     ObjectKind::kBookshelf, ObjectKind::kDesk};
  static constexpr ObjectKind kFlat[] = {ObjectKind::kBookshelf, ObjectKind::kCabinet,
                                         ObjectKind::kPlant,     ObjectKind::kBench,
                                         ObjectKind::kCartons,   ObjectKind::kCabinet};
  p.kind = options.max_depth > 0.6 ? kDeep[random.integer(8)] : kFlat[random.integer(6)];
  const auto size = [&](double w0, double w1, double d, double h0, double h1) {
    p.width = random.uniform(w0, w1);
    p.depth = d;
    p.height = random.uniform(h0, h1);
  };
  switch (p.kind) {
    case ObjectKind::kDesk:
      size(1.3, 1.6, 0.7, 0.72, 0.76);
      break;
    case ObjectKind::kBookshelf:
      size(0.8, 1.3, 0.3, 1.1, 2.1);
      break;
    case ObjectKind::kCabinet:
      size(0.6, 1.1, 0.42, 0.7, 1.4);
      break;
    case ObjectKind::kSofa:
      size(1.4, 1.9, 0.8, 0.75, 0.85);
      break;
    case ObjectKind::kCartons:
      size(0.5, 0.9, 0.42, 0.5, 1.1);
      break;
    case ObjectKind::kPlant:
      size(0.4, 0.5, 0.45, 0.9, 1.5);
      break;
    default:
      size(1.1, 1.5, 0.38, 0.42, 0.5);
      break;
  }
}

void choose_decor(Placement& p, const FurnishOptions& options, Random& random) {
  const double pick = random.uniform();
  const auto size = [&](ObjectKind kind, double w0, double w1, double h0, double h1) {
    p.kind = kind;
    p.width = random.uniform(w0, w1);
    p.height = random.uniform(h0, h1);
    p.depth = random.uniform(0.008, 0.03);
  };
  if (options.closed_doors && pick < 0.16) {
    size(ObjectKind::kDoor, 0.95, 1.05, 2.05, 2.12);
    p.fixed = true;
  } else if (options.windows && pick < 0.12) {
    size(ObjectKind::kWindow, 1.1, 1.5, 1.0, 1.25);
    p.fixed = true;
  } else if (pick < 0.5) {
    size(ObjectKind::kPoster, 0.5, 0.85, 0.7, 1.15);
  } else if (pick < 0.72) {
    size(ObjectKind::kPainting, 0.5, 1.1, 0.4, 0.8);
  } else if (pick < 0.93) {
    size(ObjectKind::kNoticeBoard, 0.9, 1.5, 0.7, 1.0);
  } else {
    size(ObjectKind::kClock, 0.32, 0.4, 0.32, 0.4);
  }
}

bool overlaps_other(const Layout& layout, const Placement& p) {
  Vector2d low, high, other_low, other_high;
  p.footprint(low, high);
  return std::any_of(layout.placements.begin(), layout.placements.end(), [&](const Placement& q) {
    if (q.on_wall || q.kind == ObjectKind::kRug) return false;
    q.footprint(other_low, other_high);
    return (low.array() < other_high.array()).all() && (other_low.array() < high.array()).all();
  });
}

void add_chair(Layout& layout, const Placement& desk, Random& random) {
  Placement chair = desk;
  chair.kind = ObjectKind::kChair;
  chair.width = 0.46;
  chair.depth = 0.46;
  chair.height = random.uniform(0.85, 1.0);
  chair.seed = random.bits();
  chair.yaw = desk.yaw + 3.14159 + random.uniform(-0.5, 0.5);
  chair.position = desk.position - desk.axis_y() * (desk.depth + 0.5) +
                   desk.axis_x() * random.uniform(-0.2, 0.2);
  if (keeps_off_path(layout, chair, kPathMargin) && !overlaps_other(layout, chair)) {
    layout.placements.push_back(chair);
  }
}

void place_furniture(Layout& layout, const Wall& wall, const FurnishOptions& options,
                     std::vector<Span>& taken, Random& random) {
  double s = random.uniform(0.1, 0.5);
  while (s < wall.length() - 0.4) {
    Placement p = at_wall(wall, 0.0, 1.0, options, random);
    choose_furniture(p, options, random);
    const double begin = s, end = s + p.width;
    p.position = wall.from + wall.direction() * (0.5 * (begin + end));
    p.position -= p.axis_y() * 0.03;
    const bool fits = end < wall.length() - 0.05 &&
                      top_over(taken, begin - 0.1, end + 0.1) == 0.0 &&
                      keeps_off_path(layout, p, kPathMargin) && !overlaps_other(layout, p);
    if (!fits) {
      s += 0.3;
      continue;
    }
    layout.placements.push_back(p);
    const double screen = p.kind == ObjectKind::kDesk || p.kind == ObjectKind::kPlant ? 0.45 : 0.05;
    taken.push_back({begin, end, p.height + screen});
    if (p.kind == ObjectKind::kDesk) add_chair(layout, p, random);
    s = end + random.uniform(0.05, options.max_depth > 0.6 ? 0.5 : 1.6);
  }
}

void place_decor(Layout& layout, const Wall& wall, const FurnishOptions& options,
                 const std::vector<Span>& taken, Random& random) {
  double s = random.uniform(0.05, 0.3);
  while (s < wall.length() - 0.35) {
    Placement p = at_wall(wall, 0.0, 1.0, options, random);
    choose_decor(p, options, random);
    p.on_wall = true;
    const double begin = s, end = s + p.width;
    p.position = wall.from + wall.direction() * (0.5 * (begin + end));
    const double lowest = top_over(taken, begin, end);
    const double highest = layout.height - 0.1 - p.height;
    const double wished = p.kind == ObjectKind::kDoor    ? 0.0
                          : p.kind == ObjectKind::kClock ? 2.0
                                                         : 1.75 - p.height / 2;
    p.base = std::max(lowest > 0.0 ? lowest + 0.06 : 0.0, wished);
    const bool hidden_door = p.kind == ObjectKind::kDoor && lowest > 0.0;
    if (end > wall.length() - 0.05 || p.base > highest || hidden_door) {
      s += 0.2;
      continue;
    }
    layout.placements.push_back(p);
    s = end + random.uniform(0.06, 0.35);
  }
}

}  // namespace

void furnish_wall(Layout& layout, const Wall& wall, const FurnishOptions& options, Random& random) {
  std::vector<Span> taken;
  for (const Opening& opening : wall.openings) {
    taken.push_back({opening.begin - 0.1, opening.end + 0.1, layout.height});
  }
  place_furniture(layout, wall, options, taken, random);
  place_decor(layout, wall, options, taken, random);
}

void add_centre_piece(Layout& layout, const Vector2d& centre, Random& random) {
  Placement table;
  table.kind = ObjectKind::kTable;
  table.width = 1.3;
  table.depth = 0.8;
  table.height = 0.62;
  table.seed = random.bits();
  table.position = centre + Vector2d(0.0, table.depth / 2);
  table.area_min = centre - Vector2d(1.0, 0.7);
  table.area_max = centre + Vector2d(1.0, 0.7);
  layout.placements.push_back(table);
  Placement rug = table;
  rug.kind = ObjectKind::kRug;
  rug.width = 3.6;
  rug.depth = 2.6;
  rug.height = 0.012;
  rug.seed = random.bits();
  rug.position = centre + Vector2d(0.0, rug.depth / 2);
  rug.area_min = centre - Vector2d(2.4, 2.0);
  rug.area_max = centre + Vector2d(2.4, 2.0);
  layout.placements.push_back(rug);
}

}  // namespace dxslam
