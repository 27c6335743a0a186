// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/factors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace dxslam {
namespace {

using testing::HasSubstr;

bool same(const Placement& a, const Placement& b) {
  return a.kind == b.kind && a.seed == b.seed && a.position == b.position && a.yaw == b.yaw &&
         a.base == b.base;
}

std::size_t unchanged(const Layout& before, const Layout& after) {
  std::size_t count = 0;
  for (const Placement& a : before.placements) {
    for (const Placement& b : after.placements) count += same(a, b);
  }
  return count;
}

TEST(Layout, RefusesAnUnknownScene) {
  try {
    make_layout("castle", 1);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("castle"));
    EXPECT_THAT(e.what(), HasSubstr("corridor"));
  }
}

class EveryLayout : public testing::TestWithParam<std::string> {};

TEST_P(EveryLayout, FollowsItsSeed) {
  const Layout a = make_layout(GetParam(), 4), b = make_layout(GetParam(), 4),
               c = make_layout(GetParam(), 5);
  EXPECT_EQ(unchanged(a, b), a.placements.size());
  EXPECT_LT(unchanged(a, c), a.placements.size() / 10 + 1);
}

TEST_P(EveryLayout, LeavesThePathFree) {
  for (const int seed : {1, 2, 3}) {
    const Layout layout = make_layout(GetParam(), seed);
    EXPECT_GT(layout.placements.size(), 25U);
    for (const Placement& p : layout.placements) {
      if (p.on_wall || p.kind == ObjectKind::kRug) continue;
      EXPECT_TRUE(keeps_off_path(layout, p, 0.4)) << "at " << p.position.transpose();
    }
  }
}

TEST_P(EveryLayout, ChangedObjectsChangeAShareOfTheThingsAndNothingElse) {
  const Layout before = make_layout(GetParam(), 1);
  FactorOptions factors;
  factors.changed_objects = 0.4;
  Layout after = before;
  apply_factors(after, factors);
  std::size_t fixed = 0;
  for (const Placement& p : before.placements) fixed += p.fixed;
  const double loose = static_cast<double>(before.placements.size() - fixed);
  EXPECT_NEAR(static_cast<double>(unchanged(before, after)), before.placements.size() - 0.4 * loose,
              1.0);
  EXPECT_LT(after.placements.size(), before.placements.size());
  EXPECT_EQ(after.walls.size(), before.walls.size());
  EXPECT_EQ(after.path.size(), before.path.size());
  ASSERT_EQ(after.lamps.size(), before.lamps.size());
  EXPECT_EQ(after.lamps[0].color, before.lamps[0].color);
  for (const Placement& p : after.placements) {
    if (!p.on_wall && p.kind != ObjectKind::kRug) {
      EXPECT_TRUE(keeps_off_path(after, p, 0.4)) << "at " << p.position.transpose();
    }
  }
}

TEST_P(EveryLayout, IlluminationChangesTheLampsAndNothingElse) {
  const Layout before = make_layout(GetParam(), 1);
  FactorOptions factors;
  factors.illumination = 0.7;
  Layout after = before;
  apply_factors(after, factors);
  EXPECT_EQ(unchanged(before, after), before.placements.size());
  EXPECT_GT(after.lamps.size(), before.lamps.size());
  EXPECT_NE(after.lamps[0].color, before.lamps[0].color);
  EXPECT_NE(after.ambient, before.ambient);
}

INSTANTIATE_TEST_SUITE_P(Scenes, EveryLayout, testing::ValuesIn(scene_names()),
                         [](const auto& scene) { return scene.param; });

TEST(Factors, ViewpointMovesThePathOnly) {
  FactorOptions factors;
  factors.viewpoint = 0.5;
  const PathOptions plain, moved = path_with_factors(plain, factors);
  EXPECT_DOUBLE_EQ(moved.sideways, 0.175);
  EXPECT_DOUBLE_EQ(moved.raise, 0.1);
  EXPECT_DOUBLE_EQ(moved.turn, 7.5);
  EXPECT_EQ(moved.speed, plain.speed);
  const Layout before = make_layout("room", 1);
  Layout after = before;
  apply_factors(after, factors);
  EXPECT_EQ(unchanged(before, after), before.placements.size());
}

TEST(Factors, ExposureDriftSwingsWithinItsBounds) {
  FactorOptions factors;
  EXPECT_EQ(exposure_gain(factors, 3.0), 1.0);
  factors.exposure_drift = 1.0;
  double low = 10.0, high = 0.0;
  for (double t = 0.0; t < 60.0; t += 0.1) {
    low = std::min(low, exposure_gain(factors, t));
    high = std::max(high, exposure_gain(factors, t));
    EXPECT_NEAR(exposure_gain(factors, t + 0.03) / exposure_gain(factors, t), 1.0, 0.05);
  }
  EXPECT_GT(low, 0.64);
  EXPECT_LT(low, 0.75);
  EXPECT_GT(high, 1.35);
  EXPECT_LT(high, 1.52);
}

TEST(Factors, AreSetByName) {
  FactorOptions factors;
  set_factor(factors, "people");
  set_factor(factors, "low_light=0.06");
  EXPECT_EQ(factors.people, 0.7);
  EXPECT_EQ(factors.low_light, 0.06);
  for (const FactorName& factor : factor_names()) {
    FactorOptions all;
    all.*factor.strength = 0.0;
    set_factor(all, factor.name);
    EXPECT_EQ(all.*factor.strength, factor.usual);
  }
}

TEST(Factors, RefuseUnknownNamesAndStrengths) {
  const auto message = [](const std::string& text) -> std::string {
    FactorOptions factors;
    try {
      set_factor(factors, text);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(message("rain"), HasSubstr("illumination"));
  EXPECT_THAT(message("people=many"), HasSubstr("people=many"));
  EXPECT_THAT(message("changed_objects=1.5"), HasSubstr("changed_objects"));
  EXPECT_THAT(message("people=nan"), HasSubstr("people"));
}

}  // namespace
}  // namespace dxslam
