// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "relocalization/confidence.h"

#include <gtest/gtest.h>

#include "relocalization/relocalizer.h"

namespace dxslam {
namespace {

RelocalizationReport report_of(int matched, int inliers) {
  RelocalizationReport report;
  report.has_pose = true;
  report.matched = matched;
  report.inliers = inliers;
  return report;
}

TEST(RelocalizationConfidence, RisesWithEitherKindOfEvidence) {
  EXPECT_LT(relocalization_confidence(report_of(12, 30)),
            relocalization_confidence(report_of(20, 30)));
  EXPECT_LT(relocalization_confidence(report_of(20, 20)),
            relocalization_confidence(report_of(20, 40)));
}

TEST(RelocalizationConfidence, TellsTheChanceMatchesOfOtherPlacesFromRealOnes) {
  // The most that any of some 3700 images of other places reached, and what hard queries reach.
  EXPECT_LT(relocalization_confidence(report_of(10, 16)), 0.6);
  EXPECT_LT(relocalization_confidence(report_of(10, 16)), AcceptanceOptions().min_confidence);
  EXPECT_GT(relocalization_confidence(report_of(20, 35)), AcceptanceOptions().min_confidence);
  EXPECT_GT(relocalization_confidence(report_of(160, 165)), 0.999);
}

TEST(RelocalizationConfidence, IsZeroWithoutAPoseAndDefinedForNoPoints) {
  EXPECT_EQ(relocalization_confidence(RelocalizationReport()), 0.0);
  const double none = relocalization_confidence(report_of(0, 0));
  EXPECT_GE(none, 0.0);
  EXPECT_LT(none, 1e-3);
}

}  // namespace
}  // namespace dxslam
