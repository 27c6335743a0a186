// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/trajectory_svg.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"

namespace dxslam {
namespace {

using testing::HasSubstr;
using testing::Not;

StampedPose at(double stamp, double x, double y, double z) {
  return {stamp, {Eigen::Quaterniond::Identity(), {x, y, z}}};
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t i = text.find(part); i != std::string::npos; i = text.find(part, i + 1)) ++n;
  return n;
}

// Start points of the subpaths of the thin line.
std::size_t subpaths(const std::string& svg) {
  const std::size_t stroke = svg.find("stroke-width=\"2\" stroke-linejoin");
  const std::size_t begin = svg.rfind("<path d=", stroke);
  return count(svg.substr(begin, stroke - begin), "M");
}

TEST(TrajectorySvg, ShowsTheTwoLongestAxesAndALegend) {
  const std::string svg = draw_trajectory_svg({at(0, 0, 0, 0), at(1, 4, 0.1, 2)},
                                              {at(0, 0, 0, 0), at(1, 4, 0, 2)}, "a <b> & c");
  EXPECT_THAT(svg, HasSubstr(">x (m)<"));
  EXPECT_THAT(svg, HasSubstr(">z (m)<"));
  EXPECT_THAT(svg, HasSubstr("a &lt;b&gt; &amp; c"));
  EXPECT_THAT(svg, HasSubstr("ground truth"));
  EXPECT_THAT(svg, testing::EndsWith("</svg>\n"));
  EXPECT_THAT(draw_trajectory_svg({at(0, 0, 0, 0)}, {}, "t"), Not(HasSubstr("ground truth")));
}

TEST(TrajectorySvg, InterruptsTheLineWhereTrackingWasLost) {
  Trajectory trajectory;
  for (int i = 0; i < 40; ++i) trajectory.push_back(at(0.1 * i, i, 0.5 * i, 0));
  EXPECT_EQ(subpaths(draw_trajectory_svg(trajectory, {}, "t")), 1U);
  trajectory.erase(trajectory.begin() + 10, trajectory.begin() + 25);
  EXPECT_EQ(subpaths(draw_trajectory_svg(trajectory, {}, "t")), 2U);
}

TEST(TrajectorySvg, SaysThatThereIsNoPose) {
  for (const Trajectory& truth : {Trajectory(), Trajectory{at(0, 0, 0, 0), at(1, 2, 1, 0)}}) {
    const std::string svg = draw_trajectory_svg({}, truth, "t");
    EXPECT_THAT(svg, HasSubstr("no pose"));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, testing::EndsWith("</svg>\n"));
  }
}

TEST(TrajectorySvg, EndsFarFromTheOrigin) {
  EXPECT_LT(draw_trajectory_svg({at(0, 1e18, 0, 0), at(1, 1e18, 1, 0)}, {}, "t").size(), 50000U);
}

TEST(TrajectorySvg, IsUtf8WhateverTheTitle) {
  EXPECT_THAT(draw_trajectory_svg({}, {}, "r\xE4um"), HasSubstr("r\xEF\xBF\xBDum"));
}

TEST(TrajectorySvg, TakesDegenerateTrajectoriesButNoBrokenOnes) {
  for (const double size : {0.0, 1e-12, 1e-3, 1e6}) {
    const std::string svg = draw_trajectory_svg({at(0, 0, 0, 0), at(1, size, 0, 0)}, {}, "t");
    EXPECT_THAT(svg, Not(HasSubstr("nan"))) << size;
    EXPECT_THAT(svg, Not(HasSubstr("inf"))) << size;
    EXPECT_LT(svg.size(), 20000U) << size;
  }
  EXPECT_THROW(draw_trajectory_svg({at(0, std::nan(""), 0, 0)}, {}, "t"), ContractError);
}

}  // namespace
}  // namespace dxslam
