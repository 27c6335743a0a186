// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/recordings/stamp_hint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace dxslam {
namespace {

std::string hint(double first, double step) {
  return stamp_hint({first, first + step, first + 2 * step, first + 3 * step});
}

TEST(StampHint, TellsUnitsBySizeOrStep) {
  for (const double first : {0.0, 17.5, 1.4e9}) {
    EXPECT_EQ(hint(first, 0.033), "") << first;
    EXPECT_EQ(hint(first, 1.0), "") << first;
  }
  EXPECT_THAT(hint(1.4e12, 33.0), testing::HasSubstr("look like milliseconds"));
  EXPECT_THAT(hint(1.4e15, 33e3), testing::HasSubstr("look like microseconds"));
  EXPECT_THAT(hint(1.4e18, 33e6), testing::HasSubstr("look like nanoseconds"));
  EXPECT_THAT(hint(0.0, 33.0), testing::HasSubstr("look like milliseconds"));
  EXPECT_THAT(hint(0.0, 33e3), testing::HasSubstr("look like microseconds"));
  EXPECT_THAT(hint(0.0, 33e6), testing::HasSubstr("look like nanoseconds"));
}

TEST(StampHint, HasNothingToSayAboutOneStamp) {
  EXPECT_EQ(stamp_hint({}), "");
  EXPECT_EQ(stamp_hint({1.4e18}), "");
  EXPECT_THAT(hint(1.4e9, 5.0), testing::HasSubstr("5 s apart, expected seconds"));
}

}  // namespace
}  // namespace dxslam
