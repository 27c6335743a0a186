// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <limits>
#include <opencv2/core.hpp>

#include "io/primitives/image_file.h"
#include "io/primitives/test_folder.h"
#include "io/primitives/text_file.h"

// What other programs wrote is read as they meant it. The pictures are described in
// tests/data/images/README.md.

namespace dxslam {
namespace {

constexpr int kWidth = 40;
constexpr int kHeight = 30;

std::string picture(const std::string& name) {
  return std::string(DXSLAM_SOURCE_DIR) + "/tests/data/images/" + name;
}

template <class Value, class Formula>
cv::Mat drawn(int type, Formula formula) {
  cv::Mat image(kHeight, kWidth, type);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) image.at<Value>(y, x) = formula(x, y);
  }
  return image;
}

cv::Mat drawn_color() {
  return drawn<cv::Vec3b>(CV_8UC3, [](int x, int y) {
    return cv::Vec3b(static_cast<std::uint8_t>(x * y), static_cast<std::uint8_t>(5 * y),
                     static_cast<std::uint8_t>(3 * x));
  });
}

void expect_equal(const cv::Mat& image, const cv::Mat& expected, const std::string& name,
                  double tolerance = 0.0) {
  ASSERT_EQ(image.type(), expected.type()) << name;
  ASSERT_EQ(image.size(), expected.size()) << name;
  EXPECT_LE(cv::norm(image, expected, cv::NORM_INF), tolerance) << name;
}

TEST(ImageCodecs, ReadColourOfEveryKind) {
  for (const char* name :
       {"rgb16.png", "rgb.bmp", "rgb.ppm", "rgb_lzw_predicted.tif", "rgb_packbits.tif"}) {
    expect_equal(read_color_image(picture(name)), drawn_color(), name);
  }
}

TEST(ImageCodecs, DropAlpha) {
  expect_equal(read_color_image(picture("alpha.png")), drawn_color(), "alpha.png");
}

TEST(ImageCodecs, ReadLossyColour) {
  // Blue is noise from pixel to pixel where x y wraps around, which JPEG smoothes: means only.
  for (const char* name : {"progressive.jpg", "cmyk.jpg"}) {
    const cv::Mat image = read_color_image(picture(name));
    ASSERT_EQ(image.type(), CV_8UC3) << name;
    EXPECT_LE(cv::norm(cv::mean(image), cv::mean(drawn_color())), 6.0) << name;
  }
}

TEST(ImageCodecs, ReadGrey) {
  const cv::Mat grey =
      drawn<std::uint8_t>(CV_8UC1, [](int x, int) { return static_cast<std::uint8_t>(3 * x); });
  expect_equal(read_color_image(picture("grey.bmp")), grey, "grey.bmp");
}

TEST(ImageCodecs, ReadBlackAndWhite) {
  const cv::Mat white = drawn<std::uint8_t>(
      CV_8UC1, [](int x, int y) { return static_cast<std::uint8_t>(x * y % 3 == 0 ? 255 : 0); });
  expect_equal(read_color_image(picture("bilevel.bmp")), white, "bilevel.bmp");
  expect_equal(read_color_image(picture("white_is_zero.tif")), white, "white_is_zero.tif");
}

TEST(ImageCodecs, ReadRawDepth) {
  const cv::Mat depth = drawn<std::uint16_t>(
      CV_16UC1, [](int x, int y) { return static_cast<std::uint16_t>(500 + 10 * x + 20 * y); });
  for (const char* name :
       {"u16.pgm", "u16_deflate_big_endian.tif", "u16_lzw_predicted.tif", "u16_tiles.tif"}) {
    expect_equal(read_depth_image(picture(name)), depth, name);
  }
}

TEST(ImageCodecs, ReadDepthInMetres) {
  const cv::Mat depth = drawn<float>(CV_32FC1, [](int x, int y) {
    return 0.5F + 0.01F * static_cast<float>(x) + 0.02F * static_cast<float>(y);
  });
  for (const char* name :
       {"f32.exr", "f32_lzw.tif", "f32_deflate_predicted.tif", "f32_tiles_big_endian.tif"}) {
    expect_equal(read_depth_image(picture(name)), depth, name, 1e-6);
  }
}

// Not a number, infinite, negative and absurdly far.
TEST(ImageCodecs, TakeImpossibleMetresForNoReading) {
  const TestFolder folder;
  std::string header("II*\0\x08\0\0\0\x08\0", 10);
  const auto add = [&](int tag, int type, int value) {
    for (const int number : {tag, type, 1, 0, value, 0}) {
      header += static_cast<char>(number & 0xFF);
      header += static_cast<char>(number >> 8);
    }
  };
  for (const auto& [tag, value] : {std::pair(256, 6), {257, 1}, {258, 32}, {259, 1}}) {
    add(tag, 3, value);
  }
  add(262, 3, 1);
  add(273, 4, 8 + 2 + 8 * 12);
  add(279, 4, 24);
  add(339, 3, 3);
  const float infinity = std::numeric_limits<float>::infinity();
  const float values[6] = {
      1.5F, std::numeric_limits<float>::quiet_NaN(), infinity, -infinity, -2.0F, 1e10F};
  header.append(reinterpret_cast<const char*>(values), sizeof(values));
  const cv::Mat depth = read_depth_image(folder.write("d.tif", header));
  EXPECT_EQ(cv::countNonZero(depth == cv::Mat((cv::Mat_<float>(1, 6) << 1.5F, 0, 0, 0, 0, 0))), 6);
}

// Each kind is refused with one sentence wherever it is cut.
TEST(ImageCodecs, RefuseEveryTruncation) {
  const TestFolder folder;
  for (const char* name : {"rgb.bmp", "bilevel.bmp", "rgb.ppm", "u16.pgm", "f32.exr", "f32_lzw.tif",
                           "u16_deflate_big_endian.tif", "progressive.jpg", "rgb16.png"}) {
    const std::string whole = read_file(picture(name), "a picture");
    const std::string type = name;
    for (std::size_t size = 0; size < whole.size(); size += 1 + size / 9) {
      const std::string cut = folder.write("cut", whole.substr(0, size));
      // TIFF may have its last tags behind its pixels, and needs not all of them.
      EXPECT_THROW(
          {
            if (type[0] == 'u' || type[0] == 'f') {
              read_depth_image(cut);
            } else {
              read_color_image(cut);
            }
          },
          InputError)
          << name << " cut to " << size;
    }
  }
}

}  // namespace
}  // namespace dxslam
