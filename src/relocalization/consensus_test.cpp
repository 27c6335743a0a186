// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "relocalization/consensus.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace dxslam {
namespace {

RelocalizationReport weak_at(double x, std::uint32_t component = 0) {
  RelocalizationReport report;
  report.has_pose = true;
  report.matched = 12;
  report.inliers = 20;
  report.coverage = 0.8;
  report.component = component;
  report.world_from_camera = SE3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(x, 0.0, 0.0));
  return report;
}

TEST(RelocalizationConsensus, TakesAnAcceptedPoseAtOnce) {
  RelocalizationConsensus consensus;
  RelocalizationReport report = weak_at(1.0);
  report.accepted = true;
  const auto taken = consensus.add(0.0, report);
  ASSERT_TRUE(taken.has_value());
  EXPECT_TRUE(taken->accepted);
}

TEST(RelocalizationConsensus, TakesThreeWeakPosesThatFitAMotion) {
  RelocalizationConsensus consensus;
  EXPECT_FALSE(consensus.add(0.0, weak_at(0.00)).has_value());
  EXPECT_FALSE(consensus.add(0.1, weak_at(0.10)).has_value());
  const auto taken = consensus.add(0.2, weak_at(0.20));
  ASSERT_TRUE(taken.has_value());
  EXPECT_TRUE(taken->accepted);
  EXPECT_NEAR(taken->world_from_camera.translation().x(), 0.2, 1e-12);
  EXPECT_FALSE(consensus.add(0.3, weak_at(0.30)).has_value()) << "a new row starts";
}

TEST(RelocalizationConsensus, AJumpStartsANewRow) {
  RelocalizationConsensus consensus;
  consensus.add(0.0, weak_at(0.0));
  consensus.add(0.1, weak_at(0.1));
  EXPECT_FALSE(consensus.add(0.2, weak_at(5.0)).has_value());
  EXPECT_FALSE(consensus.add(0.3, weak_at(5.1)).has_value());
  EXPECT_TRUE(consensus.add(0.4, weak_at(5.2)).has_value());
}

// The same image again agrees with itself, and says nothing.
TEST(RelocalizationConsensus, FramesOfAClockThatStandsOrJumpsBackDoNotAgree) {
  for (const double step : {0.0, -0.1}) {
    RelocalizationConsensus consensus;
    for (int i = 0; i < 5; ++i) EXPECT_FALSE(consensus.add(1.0 + i * step, weak_at(0.0)));
  }
}

TEST(RelocalizationConsensus, ATurnTooFastStartsANewRow) {
  RelocalizationConsensus consensus;
  consensus.add(0.0, weak_at(0.0));
  consensus.add(0.1, weak_at(0.0));
  RelocalizationReport turned = weak_at(0.0);
  turned.world_from_camera = SE3(so3_exp(Eigen::Vector3d(0.0, 0.5, 0.0)), Eigen::Vector3d::Zero());
  EXPECT_FALSE(consensus.add(0.2, turned).has_value());
}

TEST(RelocalizationConsensus, PosesInDifferentComponentsAgreeOnNothing) {
  RelocalizationConsensus consensus;
  consensus.add(0.0, weak_at(0.0, 0));
  consensus.add(0.1, weak_at(0.0, 1));
  EXPECT_FALSE(consensus.add(0.2, weak_at(0.0, 0)).has_value());
}

TEST(RelocalizationConsensus, AFrameWithoutAPoseOrALongGapEndsTheRow) {
  RelocalizationConsensus consensus;
  consensus.add(0.0, weak_at(0.0));
  consensus.add(0.1, weak_at(0.0));
  consensus.add(0.2, RelocalizationReport());
  EXPECT_FALSE(consensus.add(0.3, weak_at(0.0)).has_value());
  consensus.add(0.4, weak_at(0.0));
  EXPECT_FALSE(consensus.add(5.0, weak_at(0.0)).has_value());
}

TEST(RelocalizationConsensus, PosesOnTooFewPointsDoNotCount) {
  RelocalizationConsensus consensus;
  RelocalizationReport faint = weak_at(0.0);
  faint.matched = 5;
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(consensus.add(0.1 * i, faint).has_value());
}

TEST(RelocalizationConsensus, PosesThatAgreeWithOnePartOfTheImageAloneDoNotCount) {
  RelocalizationConsensus consensus;
  RelocalizationReport twice = weak_at(0.0);
  twice.coverage = 0.3;
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(consensus.add(0.1 * i, twice).has_value());
}

TEST(RelocalizationConsensus, NamesTheOptionThatIsOutOfRange) {
  ConsensusOptions options;
  options.frames = 1;
  EXPECT_THROW(RelocalizationConsensus{options}, InputError);
}

}  // namespace
}  // namespace dxslam
