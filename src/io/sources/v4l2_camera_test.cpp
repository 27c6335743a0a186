// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// Two cameras of software, through all that lies between a video device and SLAM.
#include "io/sources/v4l2_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <thread>

#include "core/error.h"
#include "io/primitives/image_file.h"
#include "io/primitives/test_folder.h"
#include "io/sources/live_source.h"
#include "io/sources/open_source.h"
#include "io/sources/test_video_device.h"

namespace dxslam {
namespace {

using ::testing::HasSubstr;

constexpr int kWidth = 64;
constexpr int kHeight = 48;

class V4l2 : public ::testing::Test {
 protected:
  V4l2() {
    for (SoftwareCamera* camera : {&color_, &depth_}) {
      camera->width = kWidth;
      camera->height = kHeight;
    }
    color_.formats = {V4L2_PIX_FMT_RGB24};
    color_.row_bytes = 3 * kWidth + 8;  // devices may pad
    depth_.formats = {V4L2_PIX_FMT_GREY, V4L2_PIX_FMT_Z16};
    depth_.row_bytes = 2 * kWidth;
    calibration_ =
        folder_.write("c.yaml", "width: 64\nheight: 48\nfx: 60\nfy: 60\ncx: 31.5\ncy: 23.5\n");
  }

  std::unique_ptr<LiveCamera> open(const std::string& name = "v4l2:/c,/d?fps=15") {
    return open_v4l2(SourceName(name), calibration_, [this](const std::string& path) {
      return std::make_unique<SoftwareDevice>(path == "/c" ? color_ : depth_);
    });
  }
  std::unique_ptr<ImageSource> source(LiveOptions options = {}) {
    return make_live_source("v4l2:/c,/d", open(), {}, options);
  }
  // A frame of colour (blue, green, red) and millimetres.
  void give(double stamp, double apart = 0.0) {
    const std::string row(std::string(3 * kWidth, '\0') + std::string(8, 'x'));
    std::string rgb;
    for (int y = 0; y < kHeight; ++y) rgb += row;
    rgb[0] = 30;
    rgb[1] = 20;
    rgb[2] = 10;
    color_.give({rgb, stamp});
    std::string z(2 * kWidth * kHeight, '\0');
    for (std::size_t i = 0; i < z.size(); i += 2) z[i + 1] = 4;  // 1024 mm
    depth_.give({z, stamp + apart});
  }
  std::string error_of(const std::function<void()>& work) {
    try {
      work();
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }

  const TestFolder folder_;
  std::string calibration_;
  SoftwareCamera color_, depth_;
};

TEST_F(V4l2, GivesImagesOfBothDevices) {
  for (int i = 0; i < 3; ++i) give(5.0 + 0.1 * i, 0.004);
  const auto images = source();
  EXPECT_TRUE(images->is_live());
  EXPECT_TRUE(images->facts().has_depth);
  EXPECT_NEAR(images->facts().median_depth, 1.024, 1e-6);
  EXPECT_EQ(depth_.asked_format, V4L2_PIX_FMT_Z16);
  EXPECT_EQ(color_.asked_fps, 15.0);
  double last = 0.0;
  for (int i = 0; i < 3; ++i) {
    const auto image = images->next();
    ASSERT_TRUE(image.has_value());
    EXPECT_EQ(image->index, i);
    EXPECT_GT(image->stamp, 1.6e9);  // since 1970, whatever the device's clock
    if (i > 0) {
      EXPECT_NEAR(image->stamp - last, 0.1, 1e-4);
    }
    last = image->stamp;
    EXPECT_EQ(image->color.at<cv::Vec3b>(0, 0), cv::Vec3b(10, 20, 30));
    EXPECT_EQ(image->color.at<cv::Vec3b>(1, 0), cv::Vec3b(0, 0, 0));  // no padding in it
    EXPECT_EQ(image->depth.at<float>(5, 5), 1.024F);
  }
  EXPECT_EQ(color_.lent, 4);  // all buffers were given back
}

TEST_F(V4l2, ReadsYuvAndJpeg) {
  const cv::Mat grey(kHeight, kWidth, CV_8UC3, cv::Scalar(100, 100, 100));
  for (const std::uint32_t code : {V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_MJPEG, V4L2_PIX_FMT_GREY}) {
    color_.formats = {code};
    color_.row_bytes = code == V4L2_PIX_FMT_YUYV   ? 2 * kWidth
                       : code == V4L2_PIX_FMT_GREY ? kWidth
                                                   : 0;
    std::string bytes(static_cast<std::size_t>(color_.row_bytes) * kHeight, char{100});
    if (code == V4L2_PIX_FMT_YUYV) {
      for (std::size_t i = 0; i < bytes.size(); i += 2) bytes[i + 1] = static_cast<char>(128);
    }
    if (code == V4L2_PIX_FMT_MJPEG) bytes = encode_image("a.jpg", grey);
    color_.give({bytes, 1.0 + code});
    const auto camera = open("v4l2:/c");
    EXPECT_FALSE(camera->has_depth());
    const auto picture = camera->next(std::chrono::milliseconds(1000));
    ASSERT_TRUE(picture && picture->problem.empty()) << (picture ? picture->problem : "none");
    EXPECT_EQ(picture->image.size(), cv::Size(kWidth, kHeight));
    EXPECT_NEAR(cv::mean(picture->image.reshape(1))[0], 100.0, 3.0);
  }
}

TEST_F(V4l2, PassesOverDamagedPictures) {
  const auto camera = open("v4l2:/c");
  color_.give({"short", 1.0});
  color_.give({std::string(color_.row_bytes * kHeight, 'a'), 1.1, V4L2_BUF_FLAG_ERROR});
  for (const char* why : {"cut off", "damaged"}) {
    const auto picture = camera->next(std::chrono::milliseconds(1000));
    ASSERT_TRUE(picture.has_value());
    EXPECT_THAT(picture->problem, HasSubstr(why));
  }
  EXPECT_EQ(color_.lent, 4);
}

TEST_F(V4l2, SaysWhatIsWrongWithADevice) {
  color_.height = 100;
  EXPECT_THAT(error_of([&] { open(); }), HasSubstr("no colour images of 64x48"));
  color_.height = kHeight;
  depth_.formats = {V4L2_PIX_FMT_GREY};
  EXPECT_THAT(
      error_of([&] { open(); }),
      HasSubstr(
          "no depth images of 64x48 pixels, the size of the calibration, as Z16; it has GREY"));
  depth_.gives_pictures = false;
  EXPECT_THAT(error_of([&] { open(); }), HasSubstr("/d: this video device gives no pictures"));
  color_.start_error = EBUSY;
  EXPECT_THAT(error_of([&] { open("v4l2:/c"); }), HasSubstr("another program uses it"));
  EXPECT_FALSE(color_.streams);
  calibration_.clear();
  EXPECT_THAT(error_of([&] { open(); }), HasSubstr("expected --calibration"));
}

TEST_F(V4l2, SaysThatItWasUnplugged) {
  give(1.0);
  give(1.1);
  const auto images = source();
  EXPECT_TRUE(images->next().has_value());
  std::thread hand([this] { color_.unplug(); });
  EXPECT_THAT(error_of([&] {
                while (images->next()) {
                }
              }),
              HasSubstr("the camera was unplugged"));
  hand.join();
  EXPECT_FALSE(images->next().has_value());  // it is told once
}

TEST_F(V4l2, SaysThatNothingComes) {
  LiveOptions options;
  options.silence = std::chrono::milliseconds(100);
  EXPECT_THAT(error_of([&] { source(options); }), HasSubstr("no image for 0.1 s"));
  for (int i = 0; i < 10; ++i) give(1.0 + 0.1 * i, 50.0);
  EXPECT_THAT(error_of([&] { source(options); }), HasSubstr("s apart at best"));
}

TEST_F(V4l2, DropsWhatNobodyTakesAndStops) {
  for (int i = 0; i < 4; ++i) give(1.0 + 0.1 * i);
  const auto images = source();
  for (int i = 4; i < 20; ++i) give(1.0 + 0.1 * i);
  while (images->dropped() == 0) std::this_thread::yield();
  std::thread stopper([&] { images->stop(); });
  while (images->next()) {
  }
  stopper.join();
  EXPECT_FALSE(images->next().has_value());
}

TEST_F(V4l2, RegistersDepthOfAnotherCamera) {
  calibration_ = folder_.write(
      "r.yaml",
      "width: 64\nheight: 48\nfx: 60\nfy: 60\ncx: 31.5\ncy: 23.5\n"
      "depth_camera:\n  width: 32\n  height: 24\n  fx: 30\n  fy: 30\n  cx: 15.5\n  cy: 11.5\n"
      "  x: 0\n  y: 0\n  z: 0.1\n");
  depth_.width = 32;
  depth_.height = 24;
  depth_.row_bytes = 64;
  give(1.0);
  const auto image = source()->next();
  ASSERT_TRUE(image.has_value());
  EXPECT_EQ(image->depth.size(), cv::Size(64, 48));
  EXPECT_NEAR(image->depth.at<float>(24, 32), 1.124F, 1e-6F);
}

TEST(LiveSources, AreNamed) {
  EXPECT_TRUE(is_live_source("v4l2:/dev/video0"));
  EXPECT_FALSE(is_live_source("/data/v4l2:x"));
  EXPECT_FALSE(is_live_source("walk.mcap"));
  EXPECT_THROW(open_source("v4l2:/dev/null?fps=0", {}, {}), InputError);
  EXPECT_THROW(open_source("v4l2:/dev/null?speed=1", {}, {}), InputError);
  EXPECT_THROW(open_source("v4l2:", {}, {}), InputError);
  SequenceOptions options;
  options.color_topic = "/a";
  EXPECT_THROW(open_source("v4l2:/dev/null", options), InputError);
  options.color_topic.clear();
  options.calibration = "tum_fr1";
  for (const char* path : {"v4l2:/dev/null", "v4l2:/no/such/device", "v4l2:/etc/passwd"}) {
    EXPECT_THROW(open_source(path, options), InputError) << path;
  }
}

}  // namespace
}  // namespace dxslam
