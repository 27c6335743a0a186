// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include "io/primitives/test_folder.h"
#include "io/primitives/text_file.h"
#include "io/recordings/sequence_reader.h"

namespace dxslam {
namespace {

void write_sequence(const TestFolder& folder) {
  std::string poses;
  for (const int id : {2, 9, 10}) {
    folder.write(fmt::format("images/{}.jpg", id), test_color());
    folder.write(fmt::format("depth/{}.png", id), test_depth(100 * id));
    poses += fmt::format("1 0 0 {} 0 1 0 0 0 0 1 0 0 0 0 1\n", id);
  }
  folder.write("poses.txt", poses);
  folder.write("K.txt", "60 0 32\n0 61 24\n0 0 1\n");
}

TEST(FolderReader, OrdersFramesByNumber) {
  const TestFolder folder;
  write_sequence(folder);
  const auto sequence = open_sequence(folder.path());
  ASSERT_EQ(sequence->size(), 3U);
  EXPECT_EQ(sequence->camera().fy, 61.0);
  EXPECT_EQ(sequence->camera().width, 64);
  EXPECT_DOUBLE_EQ(sequence->stamp(2), 0.2);
  EXPECT_FLOAT_EQ(sequence->read(1)->depth.at<float>(0, 0), 0.9F);
  EXPECT_FLOAT_EQ(sequence->read(2)->depth.at<float>(0, 0), 1.0F);
  EXPECT_EQ(sequence->ground_truth()[1].world_from_camera.translation().x(), 9.0);
}

TEST(FolderReader, SaysThatTheCalibrationMayBeOfAnotherImageSize) {
  const TestFolder folder;
  write_sequence(folder);
  EXPECT_TRUE(open_sequence(folder.path())->facts().notes.empty());
  folder.write("K.txt", "30 0 16\n0 30 12\n0 0 1\n");  // of images of half the size
  EXPECT_THAT(open_sequence(folder.path())->facts().notes,
              testing::ElementsAre(testing::HasSubstr("K.txt, (16, 12), is far from the middle")));
}

TEST(FolderReader, ReadsImagesWithoutDepthOrPoses) {
  const TestFolder folder;
  write_sequence(folder);
  std::filesystem::remove_all(folder / "depth");
  std::filesystem::remove(folder / "poses.txt");
  const auto sequence = open_sequence(folder.path());
  EXPECT_TRUE(sequence->ground_truth().empty());
  const auto image = sequence->read(0);
  ASSERT_TRUE(image.has_value());
  EXPECT_TRUE(image->depth.empty());
  EXPECT_FALSE(sequence->facts().has_depth);
  expect_input_error([&] { require_depth(*sequence); }, {"no depth images"});
}

// Depth of floats is in metres, whatever the depth factor says.
TEST(FolderReader, ReadsDepthInMetresAndColourOfOtherKinds) {
  const TestFolder folder;
  const std::string pictures = std::string(DXSLAM_SOURCE_DIR) + "/tests/data/images/";
  for (const auto& [name, picture] : {std::pair("images/1.bmp", "rgb.bmp"),
                                      {"images/2.tif", "rgb_packbits.tif"},
                                      {"images/3.png", "rgb16.png"},
                                      {"depth/1.exr", "f32.exr"},
                                      {"depth/2.tif", "f32_lzw.tif"},
                                      {"depth/3.pgm", "u16.pgm"}}) {
    folder.write(name, read_file(pictures + picture, "a picture"));
  }
  folder.write("K.txt", "60 0 20\n0 61 15\n0 0 1\n");
  const auto sequence = open_sequence(folder.path());
  ASSERT_EQ(sequence->size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto image = sequence->read(i);
    ASSERT_TRUE(image.has_value()) << i;
    EXPECT_EQ(image->color.type(), CV_8UC3) << i;
    ASSERT_EQ(image->depth.type(), CV_32FC1) << i;
    EXPECT_NEAR(image->depth.at<float>(10, 20), 0.9F, 1e-6) << i;
  }
}

TEST(FolderReader, SkipsAFrameWithoutItsDepth) {
  const TestFolder folder;
  write_sequence(folder);
  std::filesystem::remove(folder / "depth/9.png");
  const auto sequence = open_sequence(folder.path());
  EXPECT_FALSE(sequence->read(1).has_value());
  EXPECT_THAT(sequence->skipped().back().reason, testing::HasSubstr("depth/9.png: no such file"));
}

TEST(FolderReader, RefusesBrokenIntrinsics) {
  const TestFolder folder;
  write_sequence(folder);
  const auto expect = [&](const std::string& text, const std::vector<std::string>& parts) {
    folder.write("K.txt", text);
    expect_input_error([&] { open_sequence(folder.path()); }, parts);
  };
  expect("60 0 32\n0 61 24\n", {"K.txt", "2 rows", "3x3"});
  expect("60 0 32\n0 61\n0 0 1\n", {"K.txt:2", "2 columns"});
  expect("60 0 32\n0 x 24\n0 0 1\n", {"K.txt:2", "'x'"});
  expect("60 1 32\n0 61 24\n0 0 1\n", {"K.txt", "skew"});
  expect("-60 0 32\n0 61 24\n0 0 1\n", {"K.txt", "fx is -60"});
  std::filesystem::remove(folder / "K.txt");
  expect_input_error([&] { open_sequence(folder.path()); }, {"K.txt", "no such file"});
}

TEST(FolderReader, GoesOnWithoutPosesThatDoNotFitTheImages) {
  const TestFolder folder;
  write_sequence(folder);
  folder.write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n");
  const auto problem = [&] { return open_sequence(folder.path())->facts().truth_problem; };
  EXPECT_THAT(problem(), testing::HasSubstr("1 poses, expected one for each of the 3 images"));
  folder.write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_THAT(problem(), testing::HasSubstr("poses.txt:1: 12 columns"));
  EXPECT_TRUE(open_sequence(folder.path())->ground_truth().empty());
}

TEST(FolderReader, CountsNumbersInNamesAndTellsOfOtherFiles) {
  const TestFolder folder;
  write_sequence(folder);
  for (const int id : {2, 9, 10}) {
    std::filesystem::rename(folder / fmt::format("images/{}.jpg", id),
                            folder / fmt::format("images/frame{}.jpg", id));
    std::filesystem::rename(folder / fmt::format("depth/{}.png", id),
                            folder / fmt::format("depth/frame{}.png", id));
  }
  folder.write("images/._frame2.jpg", "of another system");
  const auto sequence = open_sequence(folder.path());
  ASSERT_EQ(sequence->size(), 3U);
  EXPECT_FLOAT_EQ(sequence->read(2)->depth.at<float>(0, 0), 1.0F);
  EXPECT_TRUE(sequence->facts().notes.empty());
  folder.write("images/frame3.webp", "x");
  EXPECT_THAT(open_sequence(folder.path())->facts().notes,
              testing::ElementsAre(testing::HasSubstr("frame3.webp")));
}

TEST(FolderReader, RefusesAFolderWithoutImages) {
  const TestFolder folder;
  folder.write("images/notes.md", "no image");
  expect_input_error([&] { open_sequence(folder.path()); }, {"images", "no image in it"});
}

TEST(FolderReader, ReadsTheRealRecording) {
  const std::string folder = shared_data("hololens");
  if (folder.empty()) GTEST_SKIP() << "no shared data; set DXSLAM_SHARED";
  const auto sequence = open_sequence(folder);
  EXPECT_EQ(sequence->size(), 373U);
  EXPECT_EQ(sequence->ground_truth().size(), 373U);
  EXPECT_EQ(sequence->camera().width, 540);
  EXPECT_TRUE(sequence->read(372).has_value());
}

}  // namespace
}  // namespace dxslam
