// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "io/primitives/test_folder.h"
#include "io/recordings/recording_info.h"
#include "io/recordings/sequence_reader.h"
#include "io/recordings/test_bag.h"

namespace dxslam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::int64_t kStart = 1'700'000'000'000'000'000;
constexpr std::int64_t kStep = 100'000'000;
constexpr int kFrames = 3;

Camera test_camera(int width = 64, int height = 48, double f = 60.0) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = f;
  camera.cx = width / 2.0;
  camera.cy = height / 2.0;
  return camera;
}

// Three colour images of a camera that knows its calibration.
void add_colors(TestBag& bag, const std::string& camera = "/camera") {
  bag.add_camera_info(camera + "/color/camera_info", "color", test_camera());
  for (int i = 0; i < kFrames; ++i) {
    bag.add_image(camera + "/color/image_raw", "color", kStart + i * kStep, "bgr8", test_color());
  }
}

void add_depths(TestBag& bag, const std::string& topic, const std::string& frame,
                const cv::Mat& raw = test_depth(2000)) {
  for (int i = 0; i < kFrames; ++i) {
    bag.add_image(topic, frame, kStart + i * kStep + 2'000'000, "16UC1", raw);
  }
}

std::unique_ptr<RgbdSequence> open(const TestFolder& folder, const TestBag& bag,
                                   const SequenceOptions& options = {}) {
  return open_sequence(folder.write("a.bag", bag.bytes()), options);
}

TEST(BagReader, FindsColourDepthAndCalibration) {
  const TestFolder folder;
  TestBag bag;
  add_colors(bag);
  add_depths(bag, "/camera/aligned_depth_to_color/image_raw", "color");
  const auto sequence = open(folder, bag);
  ASSERT_EQ(sequence->size(), 3U);
  EXPECT_EQ(sequence->stamp(1), 1'700'000'000.1);
  EXPECT_EQ(sequence->camera().fx, 60.0);
  EXPECT_NEAR(sequence->camera().fps, 10.0, 1e-3);
  EXPECT_EQ(sequence->facts().calibration_source, "/camera/color/camera_info");
  EXPECT_TRUE(sequence->facts().notes.empty());
  const auto image = sequence->read(2);
  ASSERT_TRUE(image);
  EXPECT_EQ(cv::norm(image->color, test_color(), cv::NORM_INF), 0.0);
  EXPECT_FLOAT_EQ(image->depth.at<float>(20, 30), 2.0F);
}

TEST(BagReader, RegistersDepthOfAnotherCameraAndSize) {
  const TestFolder folder;
  TestBag bag;
  add_colors(bag);
  bag.add_camera_info("/camera/depth/camera_info", "depth", test_camera(32, 24, 30.0));
  add_depths(bag, "/camera/depth/image_rect_raw", "depth", test_depth(2000, 32, 24));
  bag.add_transform("base", "color", 0.0, 0.0, 0.0);
  bag.add_transform("base", "/depth", 0.2, 0.0, 0.1);
  const auto sequence = open(folder, bag);
  const auto image = sequence->read(0);
  ASSERT_TRUE(image);
  ASSERT_EQ(image->depth.size(), cv::Size(64, 48));
  EXPECT_NEAR(image->depth.at<float>(24, 40), 2.1F, 1e-3F);  // 0.1 m behind the colour camera
  EXPECT_EQ(image->depth.at<float>(24, 3), 0.0F);  // seen by colour alone: 0.2 m to the left
}

TEST(BagReader, RegistersDepthOfAnotherSizeInTheSameFrame) {
  const TestFolder folder;
  TestBag bag;
  add_colors(bag);
  bag.add_camera_info("/camera/depth/camera_info", "color", test_camera(32, 24, 30.0));
  add_depths(bag, "/camera/depth/image", "color", test_depth(2000, 32, 24));
  const auto image = open(folder, bag)->read(0);
  ASSERT_TRUE(image);
  EXPECT_FLOAT_EQ(image->depth.at<float>(20, 30), 2.0F);
}

TEST(BagReader, RefusesDepthWhosePlaceIsNotKnown) {
  const TestFolder folder;
  TestBag bag;
  add_colors(bag);
  bag.add_camera_info("/camera/depth/camera_info", "depth", test_camera(64, 48, 50.0));
  add_depths(bag, "/camera/depth/image_rect_raw", "depth");
  expect_input_error([&] { open(folder, bag); },
                     {"a.bag", "no transform ties frame depth to color", "depth_camera"});
  // A calibration of the user's says it.
  SequenceOptions options;
  options.calibration = folder.write(
      "c.yaml", test_calibration() + "depth_camera: {fx: 50, fy: 50, cx: 32, cy: 24, x: 0.1}\n");
  EXPECT_EQ(open(folder, bag, options)->size(), 3U);
}

TEST(BagReader, RefusesDepthOfAnotherSizeWithoutCalibration) {
  const TestFolder folder;
  TestBag bag;
  add_colors(bag);
  add_depths(bag, "/camera/depth/image_rect_raw", "depth", test_depth(2000, 32, 24));
  expect_input_error([&] { open(folder, bag); }, {"a.bag", "32x24", "64x48", "no camera_info"});
}

TEST(BagReader, TakesTheRectifiedCameraForRectifiedImages) {
  const TestFolder folder;
  TestBag bag;
  Camera distorted = test_camera();
  distorted.lens.parameters[0] = 0.05;
  bag.add_camera_info("/camera/rgb/camera_info", "color", distorted, 55.0);
  bag.add_image("/camera/rgb/image_color", "color", kStart, "bgr8", test_color());
  EXPECT_EQ(open(folder, bag)->camera().lens.parameters[0], 0.05);
  TestBag rectified;
  rectified.add_camera_info("/camera/rgb/camera_info", "color", distorted, 55.0);
  rectified.add_image("/camera/rgb/image_rect_color", "color", kStart, "bgr8", test_color());
  const auto sequence = open(folder, rectified);
  EXPECT_EQ(sequence->camera().fx, 55.0);
  EXPECT_FALSE(sequence->camera().has_distortion());
}

TEST(BagReader, ReadsCompressedPictures) {
  const TestFolder folder;
  TestBag bag;
  bag.add_camera_info("/camera/color/camera_info", "color", test_camera());
  bag.add_compressed("/camera/color/image_raw/compressed", "color", kStart,
                     "bgr8; png compressed bgr8", encode_image("c.png", test_color()));
  bag.add_compressed("/camera/aligned_depth_to_color/image_raw/compressedDepth", "color", kStart,
                     "16UC1; compressedDepth png",
                     std::string(12, '\0') + encode_image("d.png", test_depth(1500)));
  const auto image = open(folder, bag)->read(0);
  ASSERT_TRUE(image);
  EXPECT_EQ(cv::norm(image->color, test_color(), cv::NORM_INF), 0.0);
  EXPECT_FLOAT_EQ(image->depth.at<float>(20, 30), 1.5F);
}

TEST(BagReader, NamesTheFileAndTheTopicOfWhatIsWrong) {
  const TestFolder folder;
  TestBag bag;
  bag.add_camera_info("/camera/color/camera_info", "color", test_camera(64, 12));
  bag.add_image("/camera/color/image_raw", "color", kStart, "bgr8", test_color(64, 12));
  const std::string text = input_error([&] { open(folder, bag); });
  EXPECT_THAT(text,
              testing::StartsWith(folder / "a.bag: /camera/color/camera_info: camera height"));
  TestBag damaged;
  damaged.add_camera_info("/camera/color/camera_info", "color", test_camera());
  damaged.add_image("/camera/color/image_raw", "color", kStart, "bgr8", test_color(32, 24));
  EXPECT_THAT(input_error([&] { open(folder, damaged); }),
              testing::StartsWith("a.bag: /camera/color/image_raw at 17"));
}

TEST(BagReader, TakesTheTopicsThatAreNamed) {
  const TestFolder folder;
  TestBag bag;
  add_colors(bag, "/back");
  add_depths(bag, "/back/aligned_depth/image", "color", test_depth(1000));
  add_colors(bag, "/front");
  add_depths(bag, "/front/aligned_depth/image", "color", test_depth(3000));
  const auto guessed = open(folder, bag);
  EXPECT_THAT(guessed->facts().notes,
              ElementsAre(AllOf(HasSubstr("4 topics of pictures"), HasSubstr("--color-topic"))));
  SequenceOptions options;
  options.color_topic = "/front/color/image_raw";
  EXPECT_FLOAT_EQ(open(folder, bag, options)->read(0)->depth.at<float>(9, 9), 3.0F);
  options.depth_topic = "/back/aligned_depth/image";
  const auto named = open(folder, bag, options);
  EXPECT_FLOAT_EQ(named->read(0)->depth.at<float>(9, 9), 1.0F);
  EXPECT_TRUE(named->facts().notes.empty());
  options.color_topic = "/left/image";
  expect_input_error([&] { open(folder, bag, options); },
                     {"a.bag", "/left/image", "/front/color/image_raw"});
}

TEST(BagReader, RefusesTopicsOfAFolderAndListsOfABag) {
  const TestFolder folder;
  TestBag bag;
  add_colors(bag);
  SequenceOptions options;
  options.association = "pairs.txt";
  expect_input_error([&] { open(folder, bag, options); }, {"--association", "bag"});
  const TestFolder images;
  images.write("images/1.png", test_color());
  options = {};
  options.color_topic = "/camera";
  expect_input_error([&] { open_sequence(images.path(), options); }, {"--color-topic", "folder"});
}

TEST(BagReader, LeavesOutImagesWithoutDepthAndRepeatedStamps) {
  const TestFolder folder;
  TestBag bag;
  add_colors(bag);
  bag.add_image("/camera/color/image_raw", "color", kStart, "bgr8", test_color());
  bag.add_image("/camera/color/image_raw", "color", kStart + 50'000'000, "bgr8", test_color());
  add_depths(bag, "/camera/depth_registered/image", "color");
  const auto sequence = open(folder, bag);
  EXPECT_EQ(sequence->size(), 3U);
  ASSERT_EQ(sequence->skipped().size(), 2U);
  EXPECT_THAT(sequence->skipped()[0].reason, HasSubstr("given before"));
  EXPECT_THAT(sequence->skipped()[1].reason, HasSubstr("no depth image within 0.02 s"));
}

TEST(BagReader, SkipsAnImageOfAnotherSize) {
  const TestFolder folder;
  TestBag bag;
  add_colors(bag);
  bag.add_image("/camera/color/image_raw", "color", kStart + 9 * kStep, "bgr8", test_color(32, 24));
  const auto sequence = open(folder, bag);
  EXPECT_FALSE(sequence->read(3));
  EXPECT_THAT(sequence->skipped().back().reason,
              AllOf(HasSubstr("/camera/color/image_raw at"), HasSubstr("32x24"),
                    HasSubstr("expected 64x48 as /camera/color/camera_info says")));
}

TEST(BagReader, RefusesABagWithoutCalibrationUnlessOnlyAppearanceCounts) {
  const TestFolder folder;
  TestBag bag;
  bag.add_image("/image", "color", kStart, "bgr8", test_color());
  expect_input_error([&] { open(folder, bag); }, {"a.bag", "no calibration", "/image"});
  SequenceOptions options;
  options.needs_calibration = false;
  EXPECT_EQ(open(folder, bag, options)->size(), 1U);
}

TEST(BagReader, RefusesLensesThatAreNotKnown) {
  const TestFolder folder;
  TestBag bag;
  Camera fisheye = test_camera();
  fisheye.lens.parameters[0] = 0.1;
  bag.add_camera_info("/camera_info", "color", fisheye, 0.0, "omni");
  bag.add_image("/image_raw", "color", kStart, "bgr8", test_color());
  expect_input_error([&] { open(folder, bag); }, {"/camera_info", "omni", "plumb_bob"});
}

TEST(BagReader, KnowsFisheyes) {
  const TestFolder folder;
  TestBag bag;
  Camera fisheye = test_camera();
  fisheye.lens.parameters[0] = 0.1;
  bag.add_camera_info("/camera_info", "color", fisheye, 0.0, "equidistant");
  bag.add_image("/image_raw", "color", kStart, "bgr8", test_color());
  EXPECT_EQ(open(folder, bag)->camera().lens, (Lens{&kKannalaBrandt, {0.1}}));
}

TEST(BagReader, GivesWayToOtherFormatsInTheSameFolder) {
  const TestFolder folder;
  TestBag bag;
  add_colors(bag);
  folder.write("a.bag", bag.bytes());
  EXPECT_EQ(recognised_format(folder.path()), "bag");
  folder.write("rgb.txt", std::string("1 rgb/1.png\n"));
  EXPECT_EQ(recognised_format(folder.path()), "tum");
  EXPECT_EQ(recognised_format(folder / "a.bag"), "bag");
}

TEST(BagReader, RefusesAFolderOfSeveralBags) {
  const TestFolder folder;
  TestBag bag;
  add_colors(bag);
  folder.write("monday.bag", bag.bytes());
  folder.write("tuesday.bag", bag.bytes());
  expect_input_error([&] { open_sequence(folder.path()); },
                     {"several bags", "monday.bag", "tuesday.bag"});
}

// What tests/data/bags/make_realsense.py recorded with librealsense.
class RealSenseRecording : public testing::TestWithParam<const char*> {
 protected:
  std::unique_ptr<RgbdSequence> sequence_ =
      open_sequence(std::string(DXSLAM_SOURCE_DIR) + "/tests/data/bags/" + GetParam());
};

TEST_P(RealSenseRecording, HasItsCalibration) {
  const Camera& camera = sequence_->camera();
  EXPECT_EQ(sequence_->size(), 3U);
  EXPECT_EQ(camera.width, 64);
  EXPECT_EQ(camera.fx, 60.0);
  EXPECT_EQ(camera.fy, 61.0);
  EXPECT_EQ(camera.cx, 31.0);
  EXPECT_EQ(camera.depth_factor, 2000.0);
  // "Inverse Brown Conrady": the polynomial gives the ideal pixel.
  Camera polynomial = camera;
  polynomial.lens.parameters = {0.05, -0.02, 0.001, 0.002, 0.003};
  for (const Eigen::Vector2d& raw : {Eigen::Vector2d(2, 3), {60, 5}, {30, 40}}) {
    EXPECT_LT((*camera.undistort(raw) - polynomial.distort(raw)).norm(), 0.02);
  }
}

TEST_P(RealSenseRecording, RegistersDepth) {
  const auto image = sequence_->read(1);
  ASSERT_TRUE(image);
  EXPECT_EQ(image->color.at<cv::Vec3b>(10, 20), cv::Vec3b(7, 40, 36));
  const SE3 color_from_depth(so3_exp({0, 0, 0.1}), Eigen::Vector3d(0.05, 0.01, 0.002));
  for (const Eigen::Vector2i& pixel : {Eigen::Vector2i(24, 18), {10, 8}, {40, 30}}) {
    const double depth = (2100 + pixel.y() + pixel.x()) / 2000.0;
    const Eigen::Vector3d point =
        color_from_depth *
        Eigen::Vector3d((pixel.x() - 23) / 40.0 * depth, (pixel.y() - 16) / 41.0 * depth, depth);
    const Eigen::Vector2d seen = sequence_->camera().distort(sequence_->camera().project(point));
    EXPECT_NEAR(image->depth.at<float>(static_cast<int>(std::lround(seen.y())),
                                       static_cast<int>(std::lround(seen.x()))),
                point.z(), 2e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(Versions, RealSenseRecording,
                         testing::Values("realsense.bag", "realsense.db3"),
                         [](const auto& given) { return std::string(given.param).substr(10); });

// What is damaged anywhere is refused, skipped or read as something else; nothing but InputError.
TEST(BagReader, SurvivesRandomDamage) {
  const TestFolder folder;
  TestBag bag;
  add_colors(bag);
  bag.add_camera_info("/camera/depth/camera_info", "depth", test_camera(32, 24, 30.0));
  bag.add_transform("color", "depth", 0.01, 0.0, 0.0);
  add_depths(bag, "/camera/depth/image_rect_raw", "depth", test_depth(2000, 32, 24));
  const std::string whole = bag.bytes();
  // Pixels are most of the bytes and can be anything, so damage is put where all else is.
  std::vector<std::size_t> places;
  for (const char* around : {"#ROSBAG", "camera_info", "image_raw", "image_rect_raw",
                             "conn=", "bgr8", "16UC1", "plumb_bob", "tf_static", "op="}) {
    for (std::size_t at = whole.find(around); at != std::string::npos;
         at = whole.find(around, at + 1)) {
      places.push_back(at);
    }
  }
  std::mt19937 random(16);
  int usable = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::string bytes = whole;
    for (std::uint32_t flips = 1 + random() % 3; flips > 0; --flips) {
      const std::size_t at = places[random() % places.size()] + random() % 64;
      if (at >= 24) bytes[std::min(at - 24, bytes.size() - 1)] = static_cast<char>(random());
    }
    if (random() % 4 == 0) bytes.resize(random() % bytes.size());
    try {
      const auto sequence = open_sequence(folder.write("a.bag", bytes));
      for (std::size_t i = 0; i < sequence->size(); ++i) sequence->read(i);
      ++usable;
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), testing::Not(HasSubstr("\n")));
    }
  }
  EXPECT_GT(usable, 20) << "damage is small enough to come far";
}

TEST(RecordingInfo, TellsTopicsFramesAndGaps) {
  const TestFolder folder;
  TestBag bag;
  add_colors(bag);
  bag.add_image("/camera/color/image_raw", "color", kStart + 9 * kStep, "bgr8", test_color());
  const RecordingInfo info = inspect_recording(folder.write("a.bag", bag.bytes()), {});
  EXPECT_EQ(info.format, "bag");
  ASSERT_EQ(info.topics.size(), 2U);
  EXPECT_EQ(info.topics[1].name, "/camera/color/image_raw");
  EXPECT_EQ(info.topics[1].content, "bgr8 64x48");
  EXPECT_EQ(info.frames.count, 4U);
  EXPECT_NEAR(info.frames.rate, 10.0, 1e-3);
  EXPECT_EQ(info.frames.gaps, 1U);
  EXPECT_NEAR(info.frames.longest_gap, 0.7, 1e-6);
  EXPECT_NE(info.origin, nullptr);
}

TEST(RecordingInfo, SaysWhyABagCannotBeUsed) {
  const TestFolder folder;
  TestBag bag;
  bag.add_image("/image", "color", kStart, "bgr8", test_color());
  const RecordingInfo info = inspect_recording(folder.write("a.bag", bag.bytes()), {});
  EXPECT_EQ(info.topics.size(), 1U);
  EXPECT_EQ(info.origin, nullptr);
  EXPECT_THAT(info.problem, HasSubstr("no calibration"));
}

}  // namespace
}  // namespace dxslam
