// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/area_counts.h"

#include <gtest/gtest.h>

namespace dxslam {
namespace {

AreaCounts counts_of(std::initializer_list<Eigen::Vector2f> pixels) {
  AreaCounts counts(PixelBox{0.0, 0.0, 639.0, 479.0});
  for (const Eigen::Vector2f& pixel : pixels) counts.add(pixel);
  return counts;
}

TEST(AreaCounts, PixelsOfOneAreaCountTogether) {
  EXPECT_EQ(counts_of({}).occupied(), 0);
  EXPECT_EQ(counts_of({{0, 0}, {79.9F, 79.9F}}).occupied(), 1);
  EXPECT_EQ(counts_of({{79.9F, 0}, {80, 0}, {0, 80}}).occupied(), 3);
  EXPECT_EQ(counts_of({{639, 479}, {700, 500}}).occupied(), 1) << "beyond the rim";
  EXPECT_EQ(counts_of({{0, 0}, {-30, -1}}).occupied(), 1);
}

TEST(AreaCounts, OnlyAreasWithThreeOrMoreAreToldFrom) {
  const AreaCounts due =
      counts_of({{1, 1}, {2, 2}, {3, 3}, {100, 1}, {101, 1}, {102, 1}, {300, 300}});
  EXPECT_EQ(due.share_in(counts_of({})), 0.0);
  EXPECT_EQ(due.share_in(counts_of({{5, 5}})), 0.5);
  EXPECT_EQ(due.share_in(counts_of({{5, 5}, {110, 10}, {300, 300}})), 1.0);
  EXPECT_EQ(counts_of({{1, 1}, {2, 2}}).share_in(due), 0.0);
}

TEST(AreaCounts, AreLimitedAreaByArea) {
  const AreaCounts due = counts_of({{1, 1}, {2, 2}, {3, 3}, {100, 1}, {101, 1}, {102, 1}});
  const AreaCounts limited = due.limited_by(counts_of({{1, 1}, {100, 1}, {101, 1}, {102, 1}}));
  EXPECT_EQ(limited.occupied(), 2);
  EXPECT_EQ(limited.share_in(counts_of({{1, 1}})), 0.0);
  EXPECT_EQ(limited.share_in(counts_of({{101, 1}})), 1.0);
}

TEST(AreaCounts, APoseThatAgreesInOnePartOfTheImageCoversLittle) {
  const PixelBox view{0.0, 0.0, 639.0, 479.0};
  std::vector<Eigen::Vector2f> all;
  for (int y = 5; y < 480; y += 20) {
    for (int x = 5; x < 640; x += 20) all.emplace_back(x, y);
  }
  const std::vector<Eigen::Vector2f> top(all.begin(), all.begin() + 32 * 4);
  EXPECT_EQ(agreeing_share(view, all, all, all), 1.0);
  EXPECT_NEAR(agreeing_share(view, all, all, top), 1.0 / 6.0, 1e-12);
  EXPECT_EQ(agreeing_share(view, all, top, top), 1.0) << "the map knows no more";
  EXPECT_EQ(agreeing_share(view, top, all, top), 1.0) << "the image shows no more";
  EXPECT_EQ(agreeing_share(view, {}, all, {}), 0.0);
}

}  // namespace
}  // namespace dxslam
