// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include "io/primitives/test_folder.h"
#include "io/recordings/sequence_reader.h"

namespace dxslam {
namespace {

constexpr const char* kPose = "1 0 0 0.5\n0 1 0 0\n0 0 1 -2\n0 0 0 1\n";

// Raw depth that says where it is: 1000 + column, with one invalid column.
cv::Mat column_depth() {
  cv::Mat depth(480, 640, CV_16UC1);
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      depth.at<std::uint16_t>(y, x) = static_cast<std::uint16_t>(x == 400 ? 65535 : 1000 + x);
    }
  }
  return depth;
}

void write_sequence(const TestFolder& folder, const std::string& ending) {
  for (const int number : {0, 3, 10}) {
    const std::string stem = fmt::format("frame-{:06d}", number);
    folder.write(stem + ".color." + ending, test_color(640, 480));
    folder.write(stem + ".depth.png", column_depth());
    folder.write(stem + ".pose.txt", kPose);
  }
}

TEST(SevenScenesReader, ReadsPngAndJpegByNumber) {
  for (const std::string ending : {"png", "jpg"}) {
    const TestFolder folder("seq-01");
    write_sequence(folder, ending);
    const auto sequence = open_sequence(folder.path());
    ASSERT_EQ(sequence->size(), 3U);
    EXPECT_DOUBLE_EQ(sequence->stamp(2), 10.0 / 30.0);
    EXPECT_TRUE(sequence->read(1).has_value());
    ASSERT_EQ(sequence->ground_truth().size(), 3U);
    EXPECT_EQ(sequence->ground_truth()[1].world_from_camera.translation().z(), -2.0);
  }
}

TEST(SevenScenesReader, RegistersDepthToColour) {
  const TestFolder folder;
  write_sequence(folder, "jpg");
  const auto image = open_sequence(folder.path())->read(0);
  ASSERT_TRUE(image.has_value());
  const auto depth_at = [&](int x) { return image->depth.at<float>(240, x); };
  EXPECT_FLOAT_EQ(depth_at(320), 1.320F);
  // (420 - 320) * 585 / 525 + 320 = 431.4
  EXPECT_FLOAT_EQ(depth_at(420), 1.431F);
  // (40 - 320) * 585 / 525 + 320 = 8
  EXPECT_FLOAT_EQ(depth_at(40), 1.008F);
  EXPECT_EQ(depth_at(20), 0.0F) << "outside of the depth image";
  // (392 - 320) * 585 / 525 + 320 = 400.2: the invalid column
  EXPECT_EQ(depth_at(392), 0.0F);
}

TEST(SevenScenesReader, RegistersByThePlaceOfTheDepthCameraWhereItIsKnown) {
  const TestFolder folder;
  write_sequence(folder, "jpg");
  folder.write("calibration.yaml",
               "width: 640\nheight: 480\nfx: 525\nfy: 525\ncx: 320\ncy: 240\n"
               "depth_camera:\n  fx: 585\n  fy: 585\n  cx: 320\n  cy: 240\n  x: -0.03\n");
  const auto sequence = open_sequence(folder.path());
  const auto image = sequence->read(0);
  ASSERT_TRUE(image.has_value());
  // Column 420 is at (420 - 320) / 585 * 1.42 - 0.03 = 0.2127 m: 525 * 0.2127 / 1.42 = 78.7.
  EXPECT_FLOAT_EQ(image->depth.at<float>(240, 320 + 79), 1.420F);
  EXPECT_EQ(sequence->ground_truth()[0].world_from_camera.translation().z(), -2.0);
}

TEST(SevenScenesReader, GoesOnWithoutBrokenPoses) {
  const TestFolder folder;
  write_sequence(folder, "jpg");
  const auto expect = [&](const std::string& pose, const std::vector<std::string>& parts) {
    folder.write("frame-000003.pose.txt", pose);
    const auto sequence = open_sequence(folder.path());
    EXPECT_EQ(sequence->ground_truth().size(), 2U);
    EXPECT_THAT(sequence->facts().notes,
                testing::ElementsAre(testing::HasSubstr("1 frames are without a true pose")));
    for (const std::string& part : parts) {
      EXPECT_THAT(sequence->facts().truth_problem, testing::HasSubstr(part));
    }
  };
  expect("1 0 0 0\n0 1 0 0\n0 0 1 0\n", {"frame-000003.pose.txt", "12 numbers", "4x4"});
  expect("1 0 0 0\n0 1 0 nan\n0 0 1 0\n0 0 0 1\n", {"frame-000003.pose.txt:2", "'nan'"});
  expect("2 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", {"frame-000003.pose.txt", "orthonormal"});
  expect("1 0 0 0\n0 1 0 0\n0 0 -1 0\n0 0 0 1\n", {"frame-000003.pose.txt", "mirrors"});
  expect("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 1 1\n", {"frame-000003.pose.txt", "last row"});
  std::filesystem::remove(folder / "frame-000003.pose.txt");
  EXPECT_EQ(open_sequence(folder.path())->ground_truth().size(), 2U);
}

TEST(SevenScenesReader, CountsImagesWithOtherNames) {
  const TestFolder folder;
  write_sequence(folder, "jpg");
  folder.write("frame-0007.color.jpg", test_color(640, 480));
  EXPECT_THAT(open_sequence(folder.path())->facts().notes,
              testing::ElementsAre(testing::HasSubstr("1 colour images were left out")));
}

TEST(SevenScenesReader, RefusesTwoFilesForOneFrame) {
  const TestFolder folder;
  write_sequence(folder, "jpg");
  folder.write("frame-000003.color.png", test_color(640, 480));
  expect_input_error([&] { open_sequence(folder.path()); }, {"frame 3", "PNG", "JPEG"});
}

TEST(SevenScenesReader, ReadsTheRealRecording) {
  const std::string folder = shared_data("7scenes_redkitchen");
  if (folder.empty()) GTEST_SKIP() << "no shared data; set DXSLAM_SHARED";
  const auto sequence = open_sequence(folder);
  EXPECT_EQ(sequence->size(), 500U);
  EXPECT_EQ(sequence->ground_truth().size(), 500U);
  EXPECT_DOUBLE_EQ(sequence->stamp(1), 2.0 / 30.0);
  const auto image = sequence->read(250);
  ASSERT_TRUE(image.has_value());
  double farthest = 0.0;
  cv::minMaxLoc(image->depth, nullptr, &farthest);
  EXPECT_LT(farthest, 20.0) << "65535 must not become a depth";
}

}  // namespace
}  // namespace dxslam
