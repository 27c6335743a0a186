// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/loop_log.h"

#include <gtest/gtest.h>

#include <vector>

namespace dxslam {
namespace {

LoopRecord record(KeyframeId query, const char* effect) {
  LoopRecord r;
  r.query = query;
  r.effect = effect;
  r.accepted = r.effect != "none";
  return r;
}

std::vector<KeyframeId> queries(const LoopLog& log) {
  std::vector<KeyframeId> all;
  for (const LoopRecord& r : log.records()) all.push_back(r.query);
  return all;
}

TEST(LoopLog, ForgetsRejectedCandidatesFirst) {
  LoopLog log(3);
  log.add(record(1, "weld"));
  for (KeyframeId query = 2; query <= 5; ++query) log.add(record(query, "none"));
  EXPECT_EQ(queries(log), (std::vector<KeyframeId>{1, 4, 5}));
  EXPECT_EQ(log.forgotten(), 2U);
  for (const KeyframeId query : {6U, 7U, 8U}) log.add(record(query, "bend"));
  EXPECT_EQ(queries(log), (std::vector<KeyframeId>{6, 7, 8}));
  EXPECT_EQ(log.forgotten(), 5U);
  EXPECT_EQ(log.accepted(), 4U);
  EXPECT_EQ(log.corrections(), 3U);
}

}  // namespace
}  // namespace dxslam
