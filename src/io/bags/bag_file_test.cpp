// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/bags/bag_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "core/error.h"
#include "io/bags/decompress.h"
#include "io/bags/ros_message.h"
#include "io/bags/ros_picture.h"
#include "io/primitives/test_folder.h"
#include "io/primitives/text_file.h"

namespace dxslam {
namespace {

using testing::HasSubstr;

// What tests/data/bags/make_bags.py wrote, by libraries that are not ours.
const std::string kBags = std::string(DXSLAM_SOURCE_DIR) + "/tests/data/bags/";
constexpr std::int64_t kStart = 1'700'000'000'000'000'000;

std::uint32_t topic_named(const BagFile& bag, const std::string& name) {
  for (std::uint32_t i = 0; i < bag.topics().size(); ++i) {
    if (bag.topics()[i].name == name) return i;
  }
  ADD_FAILURE() << "no topic " << name;
  return 0;
}

void expect_color(const cv::Mat& bgr, int frame) {
  ASSERT_EQ(bgr.size(), cv::Size(16, 12));
  ASSERT_EQ(bgr.type(), CV_8UC3);
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 16; ++x) {
      EXPECT_EQ(bgr.at<cv::Vec3b>(y, x),
                cv::Vec3b(7, static_cast<uchar>(20 * y), static_cast<uchar>(16 * frame + x)));
    }
  }
}

void expect_depth(const cv::Mat& raw, int frame) {
  ASSERT_EQ(raw.size(), cv::Size(16, 12));
  ASSERT_EQ(raw.type(), CV_16UC1);
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 16; ++x) {
      EXPECT_EQ(raw.at<std::uint16_t>(y, x), 1000 + 100 * frame + 10 * y + x);
    }
  }
}

class EveryBag : public testing::TestWithParam<const char*> {};

TEST_P(EveryBag, HasTopicsWithTypesAndCounts) {
  const auto bag = open_bag(kBags + GetParam());
  EXPECT_TRUE(bag->notes().empty());
  ASSERT_EQ(bag->topics().size(), 5U);
  const BagTopic& color = bag->topics()[topic_named(*bag, "/camera/color/image_raw")];
  EXPECT_EQ(color.type, "sensor_msgs/Image");
  EXPECT_EQ(color.messages, 3U);
  EXPECT_EQ(bag->topics()[topic_named(*bag, "/tf_static")].type, "tf2_msgs/TFMessage");
  EXPECT_EQ(bag->entries().size(), 13U);
}

TEST_P(EveryBag, GivesItsMessagesInOrder) {
  const auto bag = open_bag(kBags + GetParam());
  const std::uint32_t color = topic_named(*bag, "/camera/color/image_raw");
  const std::uint32_t depth = topic_named(*bag, "/camera/depth/image_rect_raw");
  int frame = 0;
  std::int64_t last = 0;
  for (const BagEntry& entry : bag->entries()) {
    EXPECT_GE(entry.recorded_ns, last);
    last = entry.recorded_ns;
    const std::string bytes = bag->read(entry);
    const MessageEncoding encoding = bag->topics()[entry.topic].encoding;
    if (entry.topic == color) {
      const RosImage image = read_ros_image(bytes, encoding, "colour");
      EXPECT_EQ(image.header.stamp_ns, kStart + frame * 100'000'000);
      EXPECT_EQ(image.header.frame, "color_frame");
      expect_color(color_of(image, "colour"), frame);
    } else if (entry.topic == depth) {
      const RosImage image = read_ros_image(bytes, encoding, "depth");
      EXPECT_EQ(image.header.stamp_ns, kStart + frame * 100'000'000 + 4'000'000);
      expect_depth(depth_of(image, "depth"), frame++);
    }
  }
  EXPECT_EQ(frame, 3);
}

TEST_P(EveryBag, GivesCalibrationAndTransforms) {
  const auto bag = open_bag(kBags + GetParam());
  const std::uint32_t info = topic_named(*bag, "/camera/color/camera_info");
  const std::uint32_t tf = topic_named(*bag, "/tf_static");
  for (const BagEntry& entry : bag->entries()) {
    const std::string bytes = bag->read(entry);
    const MessageEncoding encoding = bag->topics()[entry.topic].encoding;
    if (entry.topic == info) {
      const RosCameraInfo camera = read_ros_camera_info(bytes, encoding, "info");
      EXPECT_EQ(camera.width, 16U);
      EXPECT_EQ(camera.distortion_model, "plumb_bob");
      EXPECT_THAT(camera.d, testing::ElementsAre(0.01, -0.02, 0.001, 0.002, 0.0));
      EXPECT_EQ(camera.k[0], 20.0);
      EXPECT_EQ(camera.k[5], 5.5);
    } else if (entry.topic == tf) {
      const auto transforms = read_ros_transforms(bytes, encoding, "tf");
      ASSERT_EQ(transforms.size(), 1U);
      EXPECT_EQ(transforms[0].parent, "color_frame");
      EXPECT_EQ(transforms[0].child, "depth_frame");
      EXPECT_EQ(transforms[0].parent_from_child.translation().x(), 0.015);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Containers, EveryBag,
                         testing::Values("plain.bag", "lz4.bag", "bz2.bag", "sqlite", "sqlite_zstd",
                                         "mcap", "zstd.mcap", "lz4.mcap", "plain.mcap",
                                         "unchunked.mcap"),
                         [](const auto& given) {
                           std::string name = given.param;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

// Every message of a bag, or nothing where it is refused; what is wrong with single ones is
// counted.
struct Harvest {
  std::size_t whole = 0;
  std::size_t damaged = 0;
  bool refused = false;
};

Harvest harvest(const std::string& path) {
  Harvest result;
  try {
    const auto bag = open_bag(path);
    for (const BagEntry& entry : bag->entries()) {
      try {
        const std::string bytes = bag->read(entry);
        if (bag->topics()[entry.topic].type == "sensor_msgs/Image") {
          const RosImage image =
              read_ros_image(bytes, bag->topics()[entry.topic].encoding, "image");
          if (image.encoding == "rgb8") color_of(image, "image");
        }
        ++result.whole;
      } catch (const InputError&) {
        ++result.damaged;
      }
    }
  } catch (const InputError&) {
    result.refused = true;
  }
  return result;
}

void write(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

class BrokenBag : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const std::filesystem::path source = kBags + GetParam();
    bytes_ = read_file(source.string(), "a bag");
    target_ = folder_ / ("broken" + source.extension().string());
  }
  TestFolder folder_;
  std::string bytes_;
  std::string target_;
};

TEST_P(BrokenBag, CutOffGivesWhatIsWhole) {
  std::size_t most = 0;
  for (std::size_t length = 0; length < bytes_.size(); length += 151) {
    write(target_, bytes_.substr(0, length));
    const Harvest got = harvest(target_);
    EXPECT_LE(got.whole + got.damaged, 13U);
    most = std::max(most, got.whole);
  }
  EXPECT_GE(most, 9U) << "nearly the whole file gives nearly all messages";
}

TEST_P(BrokenBag, DamagedBytesAreRefusedOrRead) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 150; ++trial) {
    std::string bytes = bytes_;
    for (int flips = 1 + static_cast<int>(random() % 4); flips > 0; --flips) {
      bytes[random() % bytes.size()] = static_cast<char>(random());
    }
    write(target_, bytes);
    harvest(target_);  // no crash, nothing but InputError
  }
}

INSTANTIATE_TEST_SUITE_P(Containers, BrokenBag,
                         testing::Values("plain.bag", "lz4.bag", "bz2.bag", "sqlite/sqlite.db3",
                                         "zstd.mcap", "lz4.mcap", "plain.mcap", "unchunked.mcap"),
                         [](const auto& given) {
                           std::string name = given.param;
                           for (char& c : name) c = c == '.' || c == '/' ? '_' : c;
                           return name;
                         });

TEST(BagFile, ToldApartFromFoldersOfImages) {
  EXPECT_TRUE(is_bag(kBags + "plain.bag"));
  EXPECT_TRUE(is_bag(kBags + "sqlite"));
  EXPECT_FALSE(is_bag(kBags + "make_bags.py"));
  EXPECT_FALSE(is_bag("/nonexistent"));
}

TEST(BagFile, RefusesAnotherFileOfThatName) {
  const TestFolder folder;
  for (const char* name : {"a.bag", "a.mcap", "a.db3"}) {
    write(folder / name, "something else altogether, long enough for any head");
    try {
      open_bag(folder / name);
      ADD_FAILURE() << name;
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), HasSubstr(name));
    }
  }
}

TEST(BagFile, RefusesMetadataWithoutItsMap) {
  const TestFolder folder;
  write(folder / "metadata.yaml", "foo: rosbag2_bagfile_information\n");
  EXPECT_THROW(open_bag(folder.path()), InputError);
}

TEST(SplitBag, ReadsItsPartsAsOne) {
  const TestFolder folder;
  std::filesystem::copy(kBags + "zstd.mcap", folder / "b_0.mcap");
  std::filesystem::copy(kBags + "lz4.mcap", folder / "b_1.mcap");
  const auto bag = open_bag(folder.path());
  EXPECT_EQ(bag->topics().size(), 5U);
  EXPECT_EQ(bag->topics()[topic_named(*bag, "/camera/color/image_raw")].messages, 6U);
  EXPECT_EQ(bag->entries().size(), 26U);
  for (const BagEntry& entry : bag->entries()) EXPECT_FALSE(bag->read(entry).empty());
}

TEST(Decompress, RefusesWhatIsTooLargeOrOfAnotherSize) {
  EXPECT_THROW(decompress("abc", "none", 4, "chunk"), InputError);
  EXPECT_THROW(decompress("abc", "zstd", 1ULL << 40U, "chunk"), InputError);
  EXPECT_THROW(decompress("abc", "zstd", 3, "chunk"), InputError);
  EXPECT_THROW(decompress("abc", "lz4", 3, "chunk"), InputError);
  EXPECT_THROW(decompress("abc", "bz2", 3, "chunk"), InputError);
  EXPECT_THROW(decompress("abc", "xz", 3, "chunk"), InputError);
}

TEST(Pictures, BigEndianDepthAndPaddedRows) {
  // Two rows of two readings, each row padded by two bytes.
  const std::string data("\x01\x02\x03\x04\xEE\xEE\x05\x06\x07\x08\xEE\xEE", 12);
  RosImage image;
  image.height = image.width = 2;
  image.encoding = "16UC1";
  image.step = 6;
  image.big_endian = true;
  image.data = data;
  const cv::Mat depth = depth_of(image, "depth");
  EXPECT_EQ(depth.at<std::uint16_t>(0, 0), 0x0102);
  EXPECT_EQ(depth.at<std::uint16_t>(1, 1), 0x0708);
  image.height = 3;
  EXPECT_THROW(depth_of(image, "depth"), InputError);
}

TEST(Pictures, UndoesRvl) {
  // 3x1: no zeros, three readings 5, 3, 4, that is differences +5, -2, +1: zigzag 10, 3, 2.
  // Groups of three bits with a bit that says more: 0 | 3 | 10 = 0b1010 -> 1010 0001 | 3 | 2.
  const unsigned char words[] = {3, 0, 0, 0, 1, 0, 0, 0, 0x00, 0x32, 0xA1, 0x03};
  const cv::Mat depth = decode_rvl({reinterpret_cast<const char*>(words), sizeof(words)}, "depth");
  ASSERT_EQ(depth.size(), cv::Size(3, 1));
  EXPECT_EQ(depth.at<std::uint16_t>(0, 0), 5);
  EXPECT_EQ(depth.at<std::uint16_t>(0, 1), 3);
  EXPECT_EQ(depth.at<std::uint16_t>(0, 2), 4);
  EXPECT_THROW(decode_rvl({reinterpret_cast<const char*>(words), 9}, "depth"), InputError);
}

TEST(Messages, BothEndsOfCdr) {
  // Header only: stamp 1.5 s, frame "ab".
  const std::string little("\0\1\0\0\1\0\0\0\0\x65\xCD\x1D\3\0\0\0ab\0", 19);
  const std::string big("\0\0\0\0\0\0\0\1\x1D\xCD\x65\0\0\0\0\3ab\0", 19);
  for (const std::string& bytes : {little, big}) {
    const RosHeader header = read_ros_header(bytes, MessageEncoding::kCdr, "header");
    EXPECT_EQ(header.stamp_ns, 1'500'000'000);
    EXPECT_EQ(header.frame, "ab");
  }
}

}  // namespace
}  // namespace dxslam
