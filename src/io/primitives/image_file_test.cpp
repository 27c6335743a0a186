// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/image_file.h"

#include <zlib.h>

#include <cstdlib>
#include <filesystem>
#include <opencv2/core.hpp>
#include <random>

#include "io/primitives/test_folder.h"
#include "io/primitives/text_file.h"

namespace dxslam {
namespace {

TEST(ImageFile, KeepsWhatTheFileHas) {
  const TestFolder folder;
  EXPECT_EQ(read_color_image(folder.write("c.png", test_color())).type(), CV_8UC3);
  EXPECT_EQ(read_color_image(folder.write("c.jpg", test_color())).type(), CV_8UC3);
  const cv::Mat grey(48, 64, CV_8UC1, cv::Scalar(7));
  EXPECT_EQ(read_color_image(folder.write("g.png", grey)).type(), CV_8UC1);
  const cv::Mat depth = read_depth_image(folder.write("d.png", test_depth(40000)));
  ASSERT_EQ(depth.type(), CV_16UC1);
  EXPECT_EQ(depth.at<std::uint16_t>(5, 5), 40000);
}

TEST(ImageFile, RefusesWrongTypes) {
  const TestFolder folder;
  const std::string grey = folder.write("g.png", cv::Mat(48, 64, CV_8UC1, cv::Scalar(7)));
  expect_input_error([&] { read_depth_image(grey); }, {"g.png", "8-bit", "expected depth"});
  const std::string color = folder.write("c.png", test_color());
  expect_input_error([&] { read_depth_image(color); },
                     {"3 channels", "expected depth of one channel"});
  const std::string depth = folder.write("d.png", test_depth(5));
  expect_input_error([&] { read_color_image(depth); }, {"d.png", "16-bit", "expected 8-bit"});
  const std::string text = folder.write("t.png", "hello");
  expect_input_error([&] { read_color_image(text); }, {"t.png", "'hello'", "expected a PNG, JPEG"});
  const std::string lfs =
      folder.write("l.png", "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n");
  expect_input_error([&] { read_color_image(lfs); }, {"l.png", "git lfs pull"});
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

// Phones append previews and videos.
TEST(ImageFile, ReadsAJpegWithBytesBehindIt) {
  const TestFolder folder;
  folder.write("c.jpg", test_color());
  const std::string whole = folder.read("c.jpg");
  const cv::Mat image = read_color_image(folder / "c.jpg");
  for (const std::string& more : {std::string(100, '\0'), std::string("a trailer"), whole}) {
    const cv::Mat same = read_color_image(folder.write("more.jpg", whole + more));
    EXPECT_EQ(cv::norm(image, same, cv::NORM_INF), 0.0) << more.size() << " bytes behind it";
  }
  // A cut picture does not become whole by what follows it.
  const std::string cut = whole.substr(0, whole.size() * 2 / 3);
  for (const std::string& more : {std::string("\xFF\xD9"), whole}) {
    EXPECT_THROW(read_color_image(folder.write("cut.jpg", cut + more)), InputError);
  }
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

TEST(ImageFile, ComparesTheSizeBeforeDecoding) {
  const TestFolder folder;
  const ExpectedSize camera{{64, 48}, "calibration.yaml"};
  EXPECT_NO_THROW(read_color_image(folder.write("c.png", test_color()), camera));
  EXPECT_NO_THROW(read_depth_image(folder.write("d.png", test_depth(5)), camera));
  const std::string other = folder.write("o.jpg", test_color(32, 24));
  expect_input_error([&] { read_color_image(other, camera); },
                     {"o.jpg", "32x24", "expected 64x48 as calibration.yaml says"});
}

// A progressive picture whose last scan is there again and again: each costs time for all pixels.
TEST(ImageFile, RefusesThousandsOfScans) {
  const TestFolder folder;
  const std::string whole =
      read_file(std::string(DXSLAM_SOURCE_DIR) + "/tests/data/images/progressive.jpg", "a picture");
  const std::size_t last = whole.rfind("\xFF\xDA");
  std::string scans;
  for (int i = 0; i < 3000; ++i) scans += whole.substr(last, whole.size() - 2 - last);
  const std::string bomb = folder.write("b.jpg", whole.substr(0, last) + scans + "\xFF\xD9");
  expect_input_error([&] { read_color_image(bomb); }, {"b.jpg", "more than 64 scans"});
  const std::string case_file = shared_data("../cases/jpeg_scans_bomb.jpg");
  if (case_file.empty()) return;
  expect_input_error([&] { read_color_image(case_file); }, {"more than 64 scans"});
}

std::uint32_t checksum(const cv::Mat& image) {
  uLong sum = crc32(0, nullptr, 0);
  for (int y = 0; y < image.rows; ++y) {
    sum = crc32(sum, image.ptr(y), static_cast<uInt>(image.elemSize()) * image.cols);
  }
  return static_cast<std::uint32_t>(sum);
}

// The bits that OpenCV 4.6 gave for the same files, on which all published figures stand.
TEST(ImageFile, GivesThePixelsOfOpenCv) {
  const std::string tum = shared_data("tum_fr1_rpy");
  const std::string kitchen = shared_data("7scenes_redkitchen");
  if (tum.empty() || kitchen.empty()) GTEST_SKIP() << "the recordings of ../shared are not there";
  EXPECT_EQ(checksum(read_color_image(tum + "/rgb/1305031229.528748.jpg")), 0x2813F06BU);
  EXPECT_EQ(checksum(read_depth_image(tum + "/depth/1305031229.528784.png")), 0x43F4F5D9U);
  EXPECT_EQ(checksum(read_color_image(kitchen + "/frame-000122.color.jpg")), 0xA4B24E1BU);
  EXPECT_EQ(checksum(read_depth_image(kitchen + "/frame-000122.depth.png")), 0xC3DD4FB5U);
}

// Libraries complain to stderr unless they are kept from it; the program says all in one sentence.
TEST(ImageFile, PrintsNothing) {
  const TestFolder folder;
  folder.write("d.png", test_depth(777));
  folder.write("c.jpg", test_color());
  std::string png = folder.read("d.png");
  // A chunk with a wrong colour profile, behind the 33 bytes of signature and header.
  const std::string chunk = std::string("iCCPx\0\0garbage", 14);
  const auto sum = static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(chunk.data()), static_cast<uInt>(chunk.size())));
  std::string part("\0\0\0\x0A", 4);
  part += chunk;
  for (const unsigned shift : {24U, 16U, 8U, 0U}) part += static_cast<char>(sum >> shift);
  png.insert(33, part);
  std::string jpeg = folder.read("c.jpg");
  jpeg.replace(jpeg.size() - 40, 20, std::string(20, '\x55'));
  testing::internal::CaptureStderr();
  EXPECT_NO_THROW(read_depth_image(folder.write("profile.png", png)));
  EXPECT_NO_THROW(read_color_image(folder / "c.jpg"));
  try {
    read_color_image(folder.write("damaged.jpg", jpeg));
  } catch (const InputError&) {
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

/// A few bytes of `whole` changed, dropped or doubled.
std::string mutated(std::string bytes, std::mt19937& random) {
  const auto place = [&] { return random() % bytes.size(); };
  for (std::size_t i = 1 + random() % 3; i > 0 && bytes.size() > 1; --i) {
    switch (random() % 6) {
      case 0:
        bytes.erase(place(), 1 + random() % 8);
        break;
      case 1:
        bytes.insert(place(), bytes.substr(place(), 1 + random() % 8));
        break;
      case 2:
        bytes[place()] = static_cast<char>(random() % 2 == 0 ? 0xFF : 0);
        break;
      default:
        bytes[place()] ^= static_cast<char>(1 + random() % 255);
        break;
    }
  }
  return bytes;
}

// Puts the right checksum to every chunk, so that what they hold is looked at.
void mend_png(std::string& bytes) {
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      length = length << 8U | static_cast<unsigned char>(bytes[at + i]);
    }
    if (length > bytes.size() - at - 12) return;
    const auto sum = static_cast<std::uint32_t>(crc32(
        0, reinterpret_cast<const Bytef*>(bytes.data() + at + 4), static_cast<uInt>(length + 4)));
    for (std::size_t i = 0; i < 4; ++i) {
      bytes[at + 8 + length + i] = static_cast<char>(sum >> (24 - 8 * i));
    }
    at += length + 12;
  }
}

// Damage anywhere ends in one sentence or an image, never in a crash. $DXSLAM_MUTATIONS: how many
// of each file; a sanitizer build has found nothing in 10,000.
TEST(ImageFile, SurvivesRandomDamage) {
  const TestFolder folder;
  const char* wanted = std::getenv("DXSLAM_MUTATIONS");
  const int mutations = wanted != nullptr ? std::atoi(wanted) : 60;
  const ExpectedSize camera{{40, 30}, "the test"};
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(DXSLAM_SOURCE_DIR) + "/tests/data/images")) {
    if (entry.path().extension() == ".md") continue;
    std::mt19937 random(3);
    const std::string whole = read_file(entry.path().string(), "a picture");
    for (int i = 0; i < mutations; ++i) {
      std::string bytes = mutated(whole, random);
      if (entry.path().extension() == ".png" && i % 4 != 0) mend_png(bytes);
      const std::string file = folder.write("damaged", bytes);
      const auto size = i % 2 == 0 ? std::optional(camera) : std::nullopt;
      for (const auto& read : {read_color_image, read_depth_image}) {
        try {
          EXPECT_FALSE(read(file, size).empty());
        } catch (const InputError&) {
        }
      }
    }
  }
}

// Every damaged byte of a PNG is noticed by its checksums.
TEST(ImageFile, NoticesEveryDamagedByteOfAPng) {
  const TestFolder folder;
  folder.write("d.png", test_depth(777));
  const std::string whole = folder.read("d.png");
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string bytes = whole;
    bytes[at] ^= 0x10;
    EXPECT_THROW(read_depth_image(folder.write("damaged", bytes)), InputError) << "byte " << at;
  }
}

}  // namespace
}  // namespace dxslam
