// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/picture_mark.h"

#include "io/primitives/image_file.h"
#include "io/primitives/test_folder.h"

namespace dxslam {
namespace {

TEST(PictureMark, TellsOwnPicturesFromPhotosAndLeavesThePixels) {
  const cv::Mat image(20, 30, CV_8UC3, cv::Scalar(10, 20, 30));
  const FileKind kind = marked_picture_kind("a picture of ours", "dxslam match");
  for (const char* name : {"a.png", "a.jpg"}) {
    const std::string photo = encode_image(name, image);
    const std::string picture = mark_picture(photo, "dxslam match");
    EXPECT_TRUE(kind.matches(picture)) << name;
    EXPECT_FALSE(kind.matches(photo)) << name;
    EXPECT_FALSE(kind.matches(mark_picture(photo, "dxslam"))) << name;
    EXPECT_EQ(cv::norm(decode_color_image(picture, name), decode_color_image(photo, name)), 0.0);
  }
  EXPECT_EQ(mark_picture("text", "dxslam"), "text");
}

}  // namespace
}  // namespace dxslam
