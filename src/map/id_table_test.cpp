// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map/id_table.h"

#include <gtest/gtest.h>

#include "map/map_types.h"

namespace dxslam {
namespace {

using Table = IdTable<int>;

// After days of mapping the ids of points are used up.
TEST(IdTable, BeginsAgainBehindTheLastId) {
  Table table;
  EXPECT_EQ(table.free_from(7), 7U);
  table.insert(0, 1);
  table.insert(1, 2);
  table.insert(Table::kLastId, 3);
  EXPECT_EQ(table.free_from(Table::kLastId - 1), Table::kLastId - 1);
  EXPECT_EQ(table.free_from(Table::kLastId), 2U);
  EXPECT_EQ(table.free_from(kNoId), 2U);  // which stands for none
  EXPECT_EQ(*table.find(Table::kLastId), 3);
  EXPECT_EQ(table.find(kNoId), nullptr);
  table.erase(Table::kLastId);
  EXPECT_EQ(table.free_from(Table::kLastId), Table::kLastId);
  EXPECT_EQ(table.size(), 2U);
}

}  // namespace
}  // namespace dxslam
