// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/recordings/rising_stamps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace dxslam {
namespace {

using testing::ElementsAre;

TEST(RisingStamps, LeavesOutTheOneInTheWrongPlace) {
  EXPECT_THAT(out_of_order({}), ElementsAre());
  EXPECT_THAT(out_of_order({1, 2, 3}), ElementsAre(false, false, false));
  EXPECT_THAT(out_of_order({1, 9, 2, 3}), ElementsAre(false, true, false, false));
  EXPECT_THAT(out_of_order({1, 2, 0, 3}), ElementsAre(false, false, true, false));
  EXPECT_THAT(out_of_order({1, 2, 2, 3}), ElementsAre(false, false, true, false));
}

TEST(RisingStamps, LeavesOutTheSmallerPartOfAClockThatJumpsBack) {
  EXPECT_THAT(out_of_order({5, 6, 7, 8, 6, 7, 8}),
              ElementsAre(false, false, false, false, true, true, true));
}

}  // namespace
}  // namespace dxslam
