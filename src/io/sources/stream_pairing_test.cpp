// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/sources/stream_pairing.h"

#include <gtest/gtest.h>

namespace dxslam {
namespace {

LivePicture picture(bool is_depth, double stamp, int value = 0) {
  LivePicture made;
  made.is_depth = is_depth;
  made.stamp = stamp;
  made.image = cv::Mat(1, 1, is_depth ? CV_16UC1 : CV_8UC1, cv::Scalar(value));
  return made;
}

TEST(StreamPairing, TakesTheNearestDepthWhicheverComesFirst) {
  StreamPairing pairing(true, 0.02);
  pairing.add(picture(true, 0.985, 1));
  pairing.add(picture(false, 1.0));
  EXPECT_TRUE(pairing.take_pairs().empty());  // a nearer one may come
  pairing.add(picture(true, 1.005, 2));
  pairing.add(picture(true, 1.04, 3));
  pairing.add(picture(false, 1.033));
  const std::vector<PicturePair> pairs = pairing.take_pairs();
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[0].stamp, 1.0);
  EXPECT_EQ(pairs[0].raw_depth.at<std::uint16_t>(0), 2);
  EXPECT_EQ(pairs[1].raw_depth.at<std::uint16_t>(0), 3);
  EXPECT_TRUE(pairing.take_problems().empty());
}

TEST(StreamPairing, LeavesOutWhatHasNoPartner) {
  StreamPairing pairing(true, 0.02);
  pairing.add(picture(false, 1.0));
  pairing.add(picture(false, 1.033));
  pairing.add(picture(true, 1.034, 7));
  const std::vector<PicturePair> pairs = pairing.take_pairs();
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0].stamp, 1.033);
  ASSERT_EQ(pairing.take_problems().size(), 1U);
  EXPECT_TRUE(pairing.has_paired());
}

TEST(StreamPairing, TellsClocksThatDifferAndKeepsLittle) {
  StreamPairing pairing(true, 0.02);
  for (int i = 0; i < 300; ++i) {
    pairing.add(picture(false, 100.0 + i / 30.0));
    pairing.add(picture(true, 107.0 + i / 30.0));
  }
  EXPECT_FALSE(pairing.has_paired());
  EXPECT_NEAR(pairing.nearest(), 6.5, 0.6);
  EXPECT_GT(pairing.alone(), 5.0);
}

TEST(StreamPairing, TellsAStreamThatIsSilent) {
  StreamPairing pairing(true, 0.02);
  for (int i = 0; i < 200; ++i) pairing.add(picture(false, 100.0 + i / 30.0));
  EXPECT_GT(pairing.alone(), 5.0);
  EXPECT_EQ(pairing.nearest(), 0.0);
  EXPECT_EQ(pairing.take_problems().size(), 170U);
}

TEST(StreamPairing, LeavesOutStampsThatDoNotRise) {
  StreamPairing pairing(false, 0.02);
  pairing.add(picture(false, 2.0));
  pairing.add(picture(false, 2.0));
  pairing.add(picture(false, 1.0));
  EXPECT_EQ(pairing.take_pairs().size(), 1U);
  EXPECT_EQ(pairing.take_problems().size(), 2U);
}

}  // namespace
}  // namespace dxslam
