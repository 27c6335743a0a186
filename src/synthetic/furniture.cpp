// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/furniture.h"

#include <algorithm>

#include "synthetic/random.h"

namespace dxslam {
namespace {

using Eigen::Vector3d;

/// The thing being built, with its random numbers.
struct Job {
  SurfaceBuilder& builder;
  const Placement& p;
  Random random;

  Skin wood() { return builder.material(Pattern::kWood, random.integer(3)); }
  Skin tinted(Skin skin, double low, double high) {
    const double value = random.uniform(low, high);
    skin.tint =
        Eigen::Vector3d(value * random.uniform(0.8, 1.0), value * random.uniform(0.9, 1.0), value)
            .cast<float>();
    return skin;
  }
  /// A picture that nothing else has.
  Skin fresh(Pattern pattern, int width, int height) {
    return builder.picture(pattern, random.bits(), width, height);
  }
  /// One of `count` pictures that many things share, which bounds the memory of a large scene.
  Skin shared(Pattern pattern, int width, int height, int count) {
    const auto number = static_cast<std::uint64_t>(random.integer(count));
    return builder.picture(pattern, mix_seed(number, static_cast<std::uint64_t>(width)), width,
                           height);
  }
};

void build_table_top(Job& job, double z, double thickness, double leg, const Skin& top) {
  const double w = job.p.width / 2, d = job.p.depth;
  const Skin frame = job.tinted(job.wood(), 0.6, 1.0);
  job.builder.add_box({-w, -d, z - thickness}, {w, 0, z}, frame, frame, top);
  for (const double x : {-w + 0.02, w - 0.02 - leg}) {
    for (const double y : {-d + 0.02, -0.02 - leg}) {
      job.builder.add_box({x, y, 0}, {x + leg, y + leg, z - thickness}, frame);
    }
  }
}

void build_cup(Job& job, double x, double y, double z) {
  const Skin skin = job.shared(Pattern::kClothes, 64, 32, 48);
  job.builder.add_column(x, y, job.random.uniform(0.035, 0.05), z,
                         z + job.random.uniform(0.09, 0.16), 8, skin);
}

void build_stack(Job& job, double x, double y, double z) {
  const int count = job.random.integer(2, 5);
  const double w = job.random.uniform(0.09, 0.13), d = job.random.uniform(0.07, 0.09);
  for (int i = 0; i < count; ++i) {
    const double h = job.random.uniform(0.02, 0.05), dx = job.random.uniform(-0.02, 0.02);
    const Skin cover = job.shared(Pattern::kPoster, 128, 128, 64);
    const Skin side =
        job.tinted(job.builder.material(Pattern::kFabric, job.random.integer(3)), 0.5, 1.1);
    job.builder.add_box({x - w + dx, y - d, z}, {x + w + dx, y + d, z + h}, side, side, cover);
    z += h;
  }
}

void build_desk(Job& job) {
  const double z = job.p.height, w = job.p.width / 2, d = job.p.depth;
  build_table_top(job, z, 0.035, 0.05, job.shared(Pattern::kPapers, 512, 256, 24));
  const Skin body = job.tinted(job.builder.material(Pattern::kMetal, 0), 0.3, 0.6);
  const double x = job.random.uniform(-0.25, 0.25), half = job.random.uniform(0.24, 0.32);
  const double top = z + 0.12 + half * 1.15;
  job.builder.add_box({x - half, -0.2, z + 0.1}, {x + half, -0.15, top}, body,
                      job.shared(Pattern::kScreen, 512, 256, 16), body);
  job.builder.add_box({x - 0.05, -0.16, z}, {x + 0.05, -0.13, z + 0.15}, body);
  job.builder.add_box({x - 0.22, -0.5, z}, {x + 0.22, -0.35, z + 0.02}, body, body,
                      job.shared(Pattern::kKeyboard, 256, 128, 3));
  build_cup(job, w - 0.2, -d + 0.25, z);
  build_stack(job, -w + 0.22, -0.3, z);
  const Skin drawers = job.shared(Pattern::kDrawers, 128, 256, 24);
  const Skin side = job.wood();
  job.builder.add_box({w - 0.48, -d + 0.06, 0.02}, {w - 0.1, -0.06, z - 0.05}, side, drawers, side);
}

void build_table(Job& job) {
  const Skin top = job.shared(Pattern::kPapers, 512, 512, 24);
  build_table_top(job, job.p.height, 0.04, 0.06, top);
  build_stack(job, -0.3, -job.p.depth * 0.4, job.p.height);
  build_stack(job, 0.35, -job.p.depth * 0.6, job.p.height);
  build_cup(job, 0.02, -job.p.depth * 0.3, job.p.height);
  build_cup(job, 0.15, -job.p.depth * 0.75, job.p.height);
  const Skin carton = job.shared(Pattern::kCarton, 128, 128, 48);
  job.builder.add_box({-0.1, -0.52, job.p.height}, {0.1, -0.36, job.p.height + 0.14}, carton);
}

void build_chair(Job& job) {
  const double w = job.p.width / 2, d = job.p.depth, seat = 0.45;
  const Skin cloth = job.shared(Pattern::kClothes, 256, 256, 48),
             frame = job.tinted(job.wood(), 0.4, 1.0);
  job.builder.add_box({-w, -d, seat - 0.06}, {w, 0, seat}, cloth);
  job.builder.add_box({-w, -0.05, seat + 0.08}, {w, 0, job.p.height}, cloth);
  for (const double x : {-w, w - 0.04}) {
    job.builder.add_box({x, -d, 0}, {x + 0.04, -d + 0.04, seat - 0.06}, frame);
    job.builder.add_box({x, -0.045, 0}, {x + 0.04, -0.005, seat + 0.08}, frame);
  }
}

void build_bookshelf(Job& job) {
  const double w = job.p.width / 2, d = job.p.depth, h = job.p.height, board = 0.025;
  const Skin wood = job.tinted(job.wood(), 0.6, 1.1);
  job.builder.add_box({-w, -d, 0}, {-w + board, 0, h}, wood);
  job.builder.add_box({w - board, -d, 0}, {w, 0, h}, wood);
  job.builder.add_box({-w, -0.02, 0}, {w, 0, h}, wood);
  const int shelves = std::max(2, static_cast<int>(h / 0.34));
  for (int i = 0; i <= shelves; ++i) {
    const double z = 0.05 + (h - 0.05 - board) * i / shelves;
    job.builder.add_box({-w, -d, z}, {w, 0, z + board}, wood);
    if (i == shelves) break;
    const double room = (h - 0.05 - board) / shelves - board;
    const double from = -w + board, to = w - board, filled = job.random.uniform(0.6, 1.0);
    const double end = from + (to - from) * filled;
    const double tall = room * job.random.uniform(0.8, 0.96);
    const Skin books = job.shared(Pattern::kBooks, 512, 128, 64);
    const Skin pages = job.tinted(job.builder.material(Pattern::kFabric, 0), 0.7, 1.0);
    job.builder.add_box({from, -d + 0.03, z + board}, {end, -0.03, z + board + tall}, pages, books,
                        pages);
    if (to - end > 0.15) {
      const Skin carton = job.shared(Pattern::kCarton, 128, 128, 48);
      job.builder.add_box({end + 0.03, -d + 0.05, z + board},
                          {to - 0.02, -0.05, z + board + room * 0.55}, carton);
    }
  }
  if (h < 1.7) {
    build_cup(job, -w * 0.6, -d * 0.5, h);
    build_stack(job, w * 0.4, -d * 0.5, h);
  }
}

void build_cabinet(Job& job) {
  const double w = job.p.width / 2, d = job.p.depth, h = job.p.height;
  const Skin front = job.shared(Pattern::kDrawers, 256, 256, 24);
  const Skin side = job.tinted(job.wood(), 0.6, 1.0);
  job.builder.add_box({-w, -d, 0}, {w, 0, h}, side, front,
                      job.shared(Pattern::kPapers, 256, 128, 24));
  build_stack(job, -w * 0.45, -d * 0.5, h);
  const Skin carton = job.shared(Pattern::kCarton, 128, 128, 48);
  job.builder.add_box({w * 0.2, -d * 0.8, h},
                      {w * 0.85, -d * 0.25, h + job.random.uniform(0.15, 0.32)}, carton);
}

void build_sofa(Job& job) {
  const double w = job.p.width / 2, d = job.p.depth, h = job.p.height;
  const Skin cloth =
      job.tinted(job.builder.material(Pattern::kFabric, job.random.integer(3)), 0.6, 1.1);
  job.builder.add_box({-w, -d, 0}, {w, 0, 0.42}, cloth);
  job.builder.add_box({-w, -0.25, 0.42}, {w, 0, h}, cloth);
  for (const double x : {-w, w - 0.2})
    job.builder.add_box({x, -d, 0.42}, {x + 0.2, -0.25, 0.6}, cloth);
  for (const double x : {-w * 0.5, w * 0.35}) {
    const Skin cushion = job.shared(Pattern::kClothes, 128, 128, 48);
    job.builder.add_box({x - 0.2, -0.4, 0.42}, {x + 0.2, -0.26, 0.8}, cushion);
  }
}

void build_cartons(Job& job) {
  double z = 0.0;
  while (z < job.p.height) {
    const double h = job.random.uniform(0.2, 0.4), w = job.p.width * job.random.uniform(0.32, 0.5);
    const double d = job.p.depth * job.random.uniform(0.7, 1.0),
                 x = job.random.uniform(-0.04, 0.04);
    const Skin carton = job.shared(Pattern::kCarton, 256, 256, 48);
    job.builder.add_box({x - w, -d, z}, {x + w, -0.01, z + h}, carton);
    z += h;
  }
}

void build_plant(Job& job) {
  const double y = -job.p.depth / 2, r = job.p.width / 2;
  const Skin pot =
      job.tinted(job.builder.material(Pattern::kFabric, job.random.integer(3)), 0.5, 1.1);
  job.builder.add_column(0, y, r * 0.7, 0, 0.35, 8, pot);
  const Skin leaves = job.shared(Pattern::kLeaves, 256, 256, 8);
  job.builder.add_column(0, y, r * 0.8, 0.35, job.p.height * 0.75, 8, leaves);
  job.builder.add_column(0, y, r * 0.55, job.p.height * 0.75, job.p.height, 8, leaves);
}

void build_bench(Job& job) {
  build_table_top(job, job.p.height, 0.06, 0.07, job.fresh(Pattern::kRug, 256, 128));
  build_stack(job, job.random.uniform(-0.3, 0.3), -job.p.depth / 2, job.p.height);
}

void build_rug(Job& job) {
  const double w = job.p.width / 2;
  job.builder.add_quad({-w, 0, job.p.height}, {2 * w, 0, 0}, {0, -job.p.depth, 0},
                       job.fresh(Pattern::kRug, 1024, 512));
}

void build_decor(Job& job, Pattern pattern, int width, int height) {
  const double w = job.p.width / 2;
  const Skin edge = job.tinted(job.wood(), 0.3, 0.9);
  Skin front = job.fresh(pattern, width, height);
  if (pattern == Pattern::kWindow) {
    front.emission = 0.7F;
    front.tint = {1.1F, 1.0F, 0.95F};
  }
  job.builder.add_box({-w, -job.p.depth, job.p.base}, {w, 0, job.p.base + job.p.height}, edge,
                      front, edge);
}

}  // namespace

void build_placement(SurfaceBuilder& builder, const Placement& placement, int object) {
  builder.set_frame({placement.position.x(), placement.position.y(), 0.0}, placement.yaw, object,
                    placement.seed);
  Job job{builder, placement, Random(placement.seed)};
  switch (placement.kind) {
    case ObjectKind::kDesk:
      return build_desk(job);
    case ObjectKind::kTable:
      return build_table(job);
    case ObjectKind::kChair:
      return build_chair(job);
    case ObjectKind::kBookshelf:
      return build_bookshelf(job);
    case ObjectKind::kCabinet:
      return build_cabinet(job);
    case ObjectKind::kSofa:
      return build_sofa(job);
    case ObjectKind::kCartons:
      return build_cartons(job);
    case ObjectKind::kPlant:
      return build_plant(job);
    case ObjectKind::kBench:
      return build_bench(job);
    case ObjectKind::kRug:
      return build_rug(job);
    case ObjectKind::kPoster:
      return build_decor(job, Pattern::kPoster, 256, 512);
    case ObjectKind::kPainting:
      return build_decor(job, Pattern::kPainting, 512, 256);
    case ObjectKind::kNoticeBoard:
      return build_decor(job, Pattern::kNotice, 512, 256);
    case ObjectKind::kClock:
      return build_decor(job, Pattern::kClock, 128, 128);
    case ObjectKind::kDoor:
      return build_decor(job, Pattern::kDoor, 256, 512);
    case ObjectKind::kWindow:
      return build_decor(job, Pattern::kWindow, 512, 512);
  }
}

}  // namespace dxslam
