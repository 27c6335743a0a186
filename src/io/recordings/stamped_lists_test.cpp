// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// Lists with lines that cannot be used, recordings with images that are missing.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <vector>

#include "io/primitives/test_folder.h"
#include "io/recordings/listed_sequence.h"
#include "io/recordings/recording_info.h"

namespace dxslam {
namespace {

class StampedLists : public testing::Test {
 protected:
  static constexpr int kFrames = 30;

  StampedLists() {
    for (int i = 0; i < kFrames; ++i) {
      folder_.write(fmt::format("rgb/{}.png", i), test_color());
      folder_.write(fmt::format("depth/{}.png", i), test_depth(1000));
      rgb_.push_back(fmt::format("{:.1f} rgb/{}.png", 0.1 * i, i));
      depth_.push_back(fmt::format("{:.1f} depth/{}.png", 0.1 * i, i));
    }
    folder_.write("calibration.yaml", test_calibration());
  }

  std::unique_ptr<RgbdSequence> open(const SequenceOptions& options = {}) {
    write_lists();
    return open_sequence(folder_.path(), options);
  }
  RecordingInfo inspect() {
    write_lists();
    return inspect_recording(folder_.path(), {});
  }
  void remove(const std::string& name) { std::filesystem::remove(folder_ / name); }

  TestFolder folder_;
  std::vector<std::string> rgb_, depth_;

 private:
  void write_lists() {
    folder_.write("rgb.txt", fmt::format("# stamp file\n{}\n", fmt::join(rgb_, "\n")));
    folder_.write("depth.txt", fmt::format("{}", fmt::join(depth_, "\n")));
  }
};

TEST_F(StampedLists, ALineOutOfOrderCostsItself) {
  std::swap(rgb_[8], rgb_[9]);
  std::swap(rgb_[20], rgb_[21]);
  const auto sequence = open();
  EXPECT_EQ(sequence->size(), 28U);
  ASSERT_EQ(sequence->skipped().size(), 2U);
  EXPECT_THAT(sequence->skipped()[0].reason,
              testing::ContainsRegex("rgb.txt:1[01]: stamp .* is not in order"));
  for (std::size_t i = 1; i < sequence->size(); ++i) {
    EXPECT_LT(sequence->stamp(i - 1), sequence->stamp(i));
  }
}

TEST_F(StampedLists, AStampFarAheadCostsItself) {
  rgb_[3] = "1e300 rgb/3.png";
  const auto sequence = open();
  EXPECT_EQ(sequence->size(), 29U);
  EXPECT_THAT(sequence->skipped()[0].reason, testing::HasSubstr("rgb.txt:5: stamp 1e+300"));
}

TEST_F(StampedLists, ALineThatCannotBeReadCostsItself) {
  rgb_[11] = "garbage";
  rgb_[12] = "nan rgb/12.png";
  depth_.back() = "2.9";  // cut off
  const auto sequence = open();
  EXPECT_EQ(sequence->size(), 27U);
  ASSERT_EQ(sequence->skipped().size(), 3U);
  EXPECT_THAT(sequence->skipped()[0].reason, testing::HasSubstr("nearest depth image"));
  EXPECT_THAT(sequence->skipped()[1].reason, testing::HasSubstr("rgb.txt:13: 1 columns"));
  EXPECT_EQ(sequence->skipped()[1].index, 10U);
  EXPECT_THAT(sequence->facts().notes,
              testing::ElementsAre(testing::HasSubstr("depth.txt that were left out: 1;")));
}

TEST_F(StampedLists, ManySuchLinesAreNoAccident) {
  for (const int i : {5, 9, 20, 21}) rgb_[static_cast<std::size_t>(i)] = "garbage";
  expect_input_error([&] { open(); }, {"rgb.txt:7: 1 columns", "of 30 lines, 4 cannot be used"});
}

TEST_F(StampedLists, AClockThatJumpsBackByWholeFramesIsNoRepetition) {
  for (std::size_t i = 18; i < rgb_.size(); ++i) {
    rgb_[i] = fmt::format("{:.1f} rgb/{}.png", 0.1 * static_cast<double>(i - 12), i);
  }
  expect_input_error([&] { open(); }, {"rgb.txt:20: stamp 0.6 after 1.7, expected rising stamps",
                                       "of 30 lines, 12 cannot be used"});
  // The same lines twice are.
  for (std::size_t i = 18; i < rgb_.size(); ++i) rgb_[i] = rgb_[i - 12];
  EXPECT_EQ(open()->size(), 18U);
}

TEST_F(StampedLists, AssociationsAreReadAlike) {
  std::string pairs;
  for (int i = 0; i < kFrames; ++i) {
    pairs += i == 4 ? "garbage\n" : fmt::format("{0} rgb/{0}.png {0} depth/{0}.png\n", i);
  }
  SequenceOptions options;
  options.association = folder_.write("pairs.txt", pairs + "7.5 rgb/7.png 7.5 depth/7.png\n");
  const auto sequence = open(options);
  EXPECT_EQ(sequence->size(), 29U);
  EXPECT_EQ(sequence->skipped().size(), 2U);
}

TEST_F(StampedLists, ListsALittleApartGetAHint) {
  for (std::size_t i = 0; i < depth_.size(); ++i) {
    depth_[i] = fmt::format("{:.2f} depth/{}.png", 0.1 * static_cast<double>(i) + 0.03, i);
  }
  expect_input_error([&] { open(); }, {"within 0.02 s (nearest 0.03 s)", "--association FILE"});
}

TEST_F(StampedLists, TheFirstImagesMayBeMissing) {
  for (int i = 0; i < 25; ++i) remove(fmt::format("{}/{}.png", i % 2 == 0 ? "rgb" : "depth", i));
  EXPECT_NEAR(open()->facts().median_depth, 1.0, 1e-6);
  for (int i = 25; i < kFrames; ++i) remove(fmt::format("rgb/{}.png", i));
  expect_input_error([&] { open(); }, {"rgb/0.png: no such file"});
}

TEST(ProbeOrder, BeginsWithTheFirstTenAndSpreadsOverTheRest) {
  EXPECT_THAT(probe_order(3), testing::ElementsAre(0, 1, 2));
  EXPECT_EQ(probe_order(30).size(), 30U);
  const std::vector<std::size_t> order = probe_order(100000);
  EXPECT_EQ(order.size(), 110U);
  EXPECT_GT(order.back(), 99000U);
  EXPECT_LT(order.back(), 100000U);
}

TEST_F(StampedLists, InfoCountsMissingAndDamagedImages) {
  RecordingInfo info = inspect();
  EXPECT_EQ(info.images.absent, 0U);
  EXPECT_EQ(info.images.looked_at, 30U);
  EXPECT_EQ(info.images.damaged, 0U);
  rgb_[3] = "garbage";
  for (int i = 20; i < kFrames; ++i) remove(fmt::format("depth/{}.png", i));
  folder_.truncate("rgb/15.png", 500);
  folder_.truncate("rgb/16.png", 500);
  info = inspect();
  EXPECT_EQ(info.left_out.size(), 1U);
  EXPECT_EQ(info.images.absent, 10U);
  EXPECT_THAT(info.images.first_absent, testing::EndsWith("depth/20.png"));
  EXPECT_EQ(info.images.looked_at, 19U);
  EXPECT_EQ(info.images.damaged, 2U);
  EXPECT_THAT(info.images.first_damaged, testing::HasSubstr("rgb/15.png: truncated"));
}

TEST_F(StampedLists, AReadoutLongerThanFromImageToImageIsRefused) {
  folder_.write("calibration.yaml", test_calibration() + "fps: 1\nreadout_time: 0.1\n");
  EXPECT_EQ(open()->size(), 30U);
  folder_.write("calibration.yaml", test_calibration() + "fps: 1\nreadout_time: 0.3\n");
  expect_input_error([&] { open(); }, {"calibration.yaml: readout_time is 0.3 s", "it is 0.1 s"});
}

}  // namespace
}  // namespace dxslam
