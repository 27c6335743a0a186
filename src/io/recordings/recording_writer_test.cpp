// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/recordings/recording_writer.h"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core.hpp>

#include "core/error.h"
#include "core/image_source.h"
#include "io/bags/bag_file.h"
#include "io/bags/mcap_writer.h"
#include "io/primitives/test_folder.h"
#include "io/recordings/recording_formats.h"
#include "io/recordings/sequence_reader.h"

namespace dxslam {
namespace {

class Origin : public ImageOrigin {
 public:
  Origin() {
    camera_.width = 64;
    camera_.height = 48;
    camera_.fx = camera_.fy = 50.125;
    camera_.cx = 31.5;
    camera_.cy = 23.25;
    camera_.depth_factor = 5000.0;
    camera_.readout_time = 0.011;  // which no camera_info can say
    camera_.lens = {&kKannalaBrandt, {0.01, -0.002, 0.0003, 1e-5}};
    camera_.prepare("test");
  }
  const std::string& name() const override { return name_; }
  const Camera& camera() const override { return camera_; }
  const RecordingFacts& facts() const override { return facts_; }
  const std::vector<SkippedFrame>& skipped() const override { return skipped_; }
  const Trajectory& ground_truth() const override { return truth_; }

 private:
  std::string name_ = "origin";
  Camera camera_;
  RecordingFacts facts_;
  std::vector<SkippedFrame> skipped_;
  Trajectory truth_;
};

RgbdImage image_of(int index, float metres, int type = CV_8UC3) {
  RgbdImage image;
  image.index = index;
  image.stamp = 1'700'000'000.25 + 0.1 * index;
  image.color.create(48, 64, type);
  cv::theRNG().state = static_cast<std::uint64_t>(index) + 1;
  cv::randu(image.color, 0, 256);
  image.depth.create(48, 64, CV_32FC1);
  image.depth = metres;
  return image;
}

bool equal(const cv::Mat& a, const cv::Mat& b) {
  return a.type() == b.type() && a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

TEST(RecordingWriter, WritesMcapThatIsReadToTheBit) {
  const TestFolder folder;
  const Origin origin;
  const std::string path = folder / "a.mcap";
  const auto writer = create_recording(path, origin);
  // Of a grid of 0.2 mm, of millimetres, of neither; colour and grey.
  const std::vector<RgbdImage> images = {image_of(0, 1.2346F), image_of(1, 2.5F),
                                         image_of(2, 1.0F / 3.0F, CV_8UC1)};
  for (const RgbdImage& image : images) writer->add(image);
  writer->finish();
  EXPECT_EQ(writer->size(), 3U);
  const auto read = open_sequence(path);
  ASSERT_EQ(read->size(), images.size());
  EXPECT_EQ(read->camera().readout_time, origin.camera().readout_time);
  EXPECT_TRUE(read->camera().sees_as(origin.camera()));
  for (std::size_t i = 0; i < images.size(); ++i) {
    const auto got = read->read(i);
    ASSERT_TRUE(got.has_value());
    EXPECT_NEAR(got->stamp, images[i].stamp, 1e-6);
    EXPECT_TRUE(equal(got->color, images[i].color));
    EXPECT_TRUE(equal(got->depth, images[i].depth));
  }
}

TEST(RecordingWriter, WritesFoldersAndSaysWhatIsRounded) {
  const TestFolder folder;
  const Origin origin;
  const auto writer = create_recording(folder / "a", origin);
  const RgbdImage exact = image_of(0, 1.25F);
  writer->add(exact);
  EXPECT_TRUE(writer->notes().empty());
  RgbdImage far = image_of(1, 1.0F / 3.0F);
  far.depth.at<float>(0, 0) = 20.0F;
  writer->add(far);
  ASSERT_EQ(writer->notes().size(), 1U);
  const auto read = open_sequence(folder / "a");
  ASSERT_EQ(read->size(), 2U);
  EXPECT_TRUE(equal(read->read(0)->color, exact.color));
  EXPECT_TRUE(equal(read->read(0)->depth, exact.depth));
  EXPECT_EQ(read->read(1)->depth.at<float>(0, 0), 0.0F);
  EXPECT_NEAR(read->read(1)->depth.at<float>(1, 1), 1.0F / 3.0F, 1e-4F);
  EXPECT_EQ(read->camera(), origin.camera());
}

TEST(RecordingWriter, ReplacesNothing) {
  const TestFolder folder;
  const Origin origin;
  folder.write("a.mcap", "precious");
  EXPECT_THROW(create_recording(folder / "a.mcap", origin), InputError);
  EXPECT_THROW(create_recording(folder.path(), origin), InputError);
  EXPECT_THROW(create_recording(folder / "a.db3", origin), InputError);
  EXPECT_THROW(create_recording(folder / "no/a.mcap", origin), InputError);
}

TEST(McapWriter, FilesAreReadWithAndWithoutTheirEnd) {
  const TestFolder folder;
  for (const std::string compression : {"", "zstd", "lz4"}) {
    SCOPED_TRACE(compression);
    const std::string path = folder / ("a" + compression + ".mcap");
    McapWriter writer(path, compression);
    const auto a = writer.add_topic("/a", "std_msgs/msg/String", "string data\n");
    const auto b = writer.add_topic("/b", "std_msgs/msg/String", "string data\n");
    for (std::uint64_t i = 0; i < 4; ++i) {
      writer.add(a, i, std::string(1000, static_cast<char>('a' + i)));
      if (i == 2) writer.add(b, i, "late");
      writer.flush();
    }
    for (const bool finished : {false, true}) {
      if (finished) writer.finish();
      const auto bag = open_bag(path);
      EXPECT_TRUE(bag->notes().empty());
      ASSERT_EQ(bag->entries().size(), 5U);
      EXPECT_EQ(bag->topics().size(), 2U);
      EXPECT_EQ(bag->read(bag->entries()[1]), std::string(1000, 'b'));
      EXPECT_EQ(bag->entries()[4].recorded_ns, 3);
    }
  }
}

TEST(RawDepth, SaysWhetherItIsExact) {
  const cv::Mat metres = (cv::Mat_<float>(1, 3) << 0.0F, 1.25F, 65.535F);
  bool exact = false;
  cv::Mat raw = raw_depth(metres, 1000.0, exact);
  EXPECT_TRUE(exact);
  EXPECT_EQ(raw.at<std::uint16_t>(2), 65535);
  raw = raw_depth(2 * metres, 1000.0, exact);
  EXPECT_FALSE(exact);
  EXPECT_EQ(raw.at<std::uint16_t>(2), 0);
}

}  // namespace
}  // namespace dxslam
