// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include "io/primitives/test_folder.h"
#include "io/recordings/sequence_reader.h"

namespace dxslam {
namespace {

// Image i is of grey value 10 i.
cv::Mat numbered(int i) { return {24, 32, CV_8UC1, cv::Scalar(10 * i)}; }

int grey(RgbdSequence& sequence, std::size_t index) {
  const auto image = sequence.read(index);
  return image ? image->color.at<std::uint8_t>(0, 0) : -1;
}

SequenceOptions without_calibration(const std::string& eye) {
  SequenceOptions options;
  options.needs_calibration = false;
  options.eye = eye;
  return options;
}

TEST(ImageFolderReader, TakesTheImagesOfOneCamera) {
  const TestFolder folder("NewCollege");
  for (int i = 1; i <= 5; ++i) folder.write(fmt::format("Images/{:04}.png", i), numbered(i));
  const auto all = open_sequence(folder.path(), without_calibration("all"));
  ASSERT_EQ(all->size(), 5U);
  EXPECT_TRUE(all->read(0)->depth.empty());
  const auto left = open_sequence(folder.path(), without_calibration("left"));
  ASSERT_EQ(left->size(), 3U);
  EXPECT_EQ(grey(*left, 1), 30);
  const auto right = open_sequence(folder.path() + "/Images", without_calibration("right"));
  ASSERT_EQ(right->size(), 2U);
  EXPECT_EQ(grey(*right, 1), 40);
  EXPECT_LT(right->stamp(0), right->stamp(1));
}

TEST(ImageFolderReader, AsksForACalibrationUnlessToldNotTo) {
  const TestFolder folder;
  folder.write("1.png", numbered(1));
  expect_input_error([&] { open_sequence(folder.path()); }, {folder.path(), "without calibration"});
  EXPECT_EQ(open_sequence(folder.path(), without_calibration("all"))->camera().fx, 32.0);
  folder.write("calibration.yaml",
               "width: 32\nheight: 24\nfx: 30\nfy: 30\ncx: 16\ncy: 12\ndepth_factor: 1000\n");
  EXPECT_EQ(open_sequence(folder.path())->camera().fx, 30.0);
  expect_input_error([&] { open_sequence(folder.path(), without_calibration("middle")); },
                     {"'middle'", "all, left or right"});
}

TEST(FolderReader, NeedsNoCameraMatrixForAppearance) {
  const TestFolder folder;
  folder.write("images/1.png", numbered(1));
  expect_input_error([&] { open_sequence(folder.path()); }, {"K.txt"});
  EXPECT_EQ(open_sequence(folder.path(), without_calibration("all"))->size(), 1U);
}

class KittiReader : public testing::Test {
 protected:
  KittiReader() : folder_("dataset") {
    for (int i = 0; i < 3; ++i) {
      folder_.write(fmt::format("sequences/07/image_0/{:06}.png", i), numbered(i));
      folder_.write(fmt::format("sequences/07/image_1/{:06}.png", i), numbered(10 + i));
    }
    folder_.write("sequences/07/times.txt", "0.0\n1.037e-01\n2.074e-01\n");
    folder_.write("sequences/07/calib.txt",
                  "P0: 20 0 16 0 0 20 12 0 0 0 1 0\nP1: 20 0 16 -10 0 20 12 0 0 0 1 0\n");
    folder_.write("poses/07.txt",
                  "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 0.9\n"
                  "0 0 1 0 0 1 0 0 -1 0 0 1.8\n");
  }
  std::string sequence() const { return folder_ / "sequences/07"; }
  TestFolder folder_;
};

TEST_F(KittiReader, ReadsImagesTimesCalibrationAndPoses) {
  const auto left = open_sequence(sequence());
  EXPECT_EQ(left->name(), "07");
  ASSERT_EQ(left->size(), 3U);
  EXPECT_EQ(left->camera().fx, 20.0);
  EXPECT_EQ(left->camera().cy, 12.0);
  EXPECT_DOUBLE_EQ(left->stamp(1), 0.1037);
  EXPECT_EQ(grey(*left, 2), 20);
  ASSERT_EQ(left->ground_truth().size(), 3U);
  EXPECT_DOUBLE_EQ(left->ground_truth()[2].world_from_camera.translation().z(), 1.8);
}

TEST_F(KittiReader, MovesThePosesToTheRightCamera) {
  SequenceOptions options;
  options.eye = "right";
  const auto right = open_sequence(sequence(), options);
  EXPECT_EQ(grey(*right, 1), 110);
  // 0.5 m to the right of the left camera, which looks along x in the last frame.
  const Eigen::Vector3d last = right->ground_truth()[2].world_from_camera.translation();
  EXPECT_LT((last - Eigen::Vector3d(0, 0, 1.3)).norm(), 1e-9);
}

TEST_F(KittiReader, SkipsAnImageOfTheSameTime) {
  folder_.write("sequences/07/times.txt", "0.0\n0.1\n0.1\n");
  const auto left = open_sequence(sequence());
  ASSERT_EQ(left->size(), 2U);
  EXPECT_EQ(left->ground_truth().size(), 2U);
  ASSERT_EQ(left->skipped().size(), 1U);
  EXPECT_THAT(left->skipped()[0].reason, testing::HasSubstr("000002.png: has the time"));
}

TEST_F(KittiReader, TellsWhichImagesItTakes) {
  folder_.write("sequences/07/image_2/000000.png", numbered(1));
  EXPECT_THAT(open_sequence(sequence())->facts().notes,
              testing::ElementsAre(testing::HasSubstr("image_0, are used")));
}

TEST_F(KittiReader, SaysWhatDoesNotFit) {
  folder_.write("sequences/07/times.txt", "0.0\n0.1\n");
  expect_input_error([&] { open_sequence(sequence()); }, {"times.txt", "2 times", "3 images"});
  folder_.write("sequences/07/times.txt", "0.0\n0.2\n0.1\n");
  expect_input_error([&] { open_sequence(sequence()); }, {"times.txt:3", "rising"});
  folder_.write("sequences/07/times.txt", "0.0\n0.1 5\n0.1\n");
  expect_input_error([&] { open_sequence(sequence()); }, {"times.txt:2", "2 columns"});
  folder_.write("sequences/07/times.txt", "0.0\n0.1\n0.2\n");
  folder_.write("poses/07.txt", "1 0 0 0 0 1 0 0 0 0 1\n");
  EXPECT_THAT(open_sequence(sequence())->facts().truth_problem,
              testing::HasSubstr("07.txt:1: 11 columns"));
  folder_.write("sequences/07/calib.txt", "P1: 20 0 16 0 0 20 12 0 0 0 1 0\n");
  expect_input_error([&] { open_sequence(sequence()); }, {"calib.txt", "P0:"});
}

}  // namespace
}  // namespace dxslam
