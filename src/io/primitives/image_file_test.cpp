// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/image_file.h"

#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <random>

#include "io/primitives/test_folder.h"

namespace dxslam {
namespace {

TEST(ImageFile, KeepsWhatTheFileHas) {
  const TestFolder folder;
  EXPECT_EQ(read_color_image(folder.write("c.png", test_color())).type(), CV_8UC3);
  EXPECT_EQ(read_color_image(folder.write("c.jpg", test_color())).type(), CV_8UC3);
  const cv::Mat grey(48, 64, CV_8UC1, cv::Scalar(7));
  EXPECT_EQ(read_color_image(folder.write("g.png", grey)).type(), CV_8UC1);
  const cv::Mat alpha(48, 64, CV_8UC4, cv::Scalar(1, 2, 3, 4));
  EXPECT_EQ(read_color_image(folder.write("a.png", alpha)).type(), CV_8UC3);
  const cv::Mat depth = read_depth_image(folder.write("d.png", test_depth(40000)));
  ASSERT_EQ(depth.type(), CV_16UC1);
  EXPECT_EQ(depth.at<std::uint16_t>(5, 5), 40000);
}

TEST(ImageFile, RefusesWrongTypes) {
  const TestFolder folder;
  const std::string grey = folder.write("g.png", cv::Mat(48, 64, CV_8UC1, cv::Scalar(7)));
  expect_input_error([&] { read_depth_image(grey); }, {"g.png", "8-bit", "expected 16-bit depth"});
  const std::string color = folder.write("c.png", test_color());
  expect_input_error([&] { read_depth_image(color); }, {"3 channels", "expected 16-bit depth"});
  const std::string depth = folder.write("d.png", test_depth(5));
  expect_input_error([&] { read_color_image(depth); }, {"d.png", "16-bit", "expected 8-bit"});
  const std::string text = folder.write("t.png", "hello");
  expect_input_error([&] { read_color_image(text); },
                     {"t.png", "'hello'", "expected a PNG or JPEG"});
  expect_input_error([&] { read_color_image(folder.write("e.png", "")); }, {"e.png", "empty"});
  expect_input_error([&] { read_color_image(folder / "none.png"); }, {"no such file"});
}

// Every cut of a file is noticed: decoders would fill the rest with grey.
TEST(ImageFile, RefusesEveryTruncation) {
  const TestFolder folder;
  for (const char* name : {"c.png", "c.jpg"}) {
    folder.write(name, test_color());
    const std::string whole = folder.read(name);
    for (std::size_t size = 1; size < whole.size(); size += 1 + size / 9) {
      const std::string cut = folder.write(std::string("cut_") + name, whole.substr(0, size));
      EXPECT_THROW(read_color_image(cut), InputError) << name << " cut to " << size;
    }
  }
}

TEST(ImageFile, AcceptsZerosBehindAJpeg) {
  const TestFolder folder;
  folder.write("c.jpg", test_color());
  folder.write("padded.jpg", folder.read("c.jpg") + std::string(100, '\0'));
  EXPECT_NO_THROW(read_color_image(folder / "padded.jpg"));
}

TEST(ImageFile, RefusesHugeImagesBeforeDecoding) {
  const TestFolder folder;
  folder.write("c.jpg", test_color());
  std::string bytes = folder.read("c.jpg");
  const std::size_t frame = bytes.find("\xFF\xC0");
  ASSERT_NE(frame, std::string::npos);
  bytes.replace(frame + 5, 4, "\xFF\xFF\xFF\xFF");
  expect_input_error([&] { read_color_image(folder.write("huge.jpg", bytes)); },
                     {"huge.jpg", "65535x65535", "16384"});
}

// Damage anywhere ends in an error or an image, never in a crash, and for PNG always in an error.
TEST(ImageFile, SurvivesRandomDamage) {
  const TestFolder folder;
  std::mt19937 random(3);
  for (const char* name : {"d.png", "c.jpg"}) {
    const bool png = std::string(name) == "d.png";
    folder.write(name, png ? test_depth(777) : test_color());
    const std::string whole = folder.read(name);
    for (int i = 0; i < 200; ++i) {
      std::string bytes = whole;
      const std::size_t at = random() % bytes.size();
      bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(1 + random() % 255));
      const std::string file = folder.write("damaged", bytes);
      if (png) {
        EXPECT_THROW(read_depth_image(file), InputError) << "byte " << at;
        continue;
      }
      try {
        EXPECT_FALSE(read_color_image(file).empty());
      } catch (const InputError&) {
      }
    }
  }
}

TEST(ImageFile, LeavesTheLogLevelOfOpenCvAlone) {
  const TestFolder folder;
  const auto before = cv::utils::logging::getLogLevel();
  read_color_image(folder.write("c.png", test_color()));
  EXPECT_EQ(cv::utils::logging::getLogLevel(), before);
}

}  // namespace
}  // namespace dxslam
