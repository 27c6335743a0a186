// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/openloris_result.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/error.h"

namespace dxslam {
namespace {

using testing::HasSubstr;

class OpenlorisResultFile : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  OpenlorisResult read(const std::string& text) {
    std::ofstream(path_) << text;
    return read_openloris_result(path_);
  }
  std::string refusal(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& e) {
      return e.what();
    }
    return "not refused";
  }

  std::string path_ =
      std::filesystem::temp_directory_path() / fmt::format("dxslam_result_{}.txt", ::getpid());
};

// The headers of published results differ like this.
TEST_F(OpenlorisResultFile, TakesHeadersInAnySpacing) {
  const OpenlorisResult result = read(
      "scene:home\nslam:vins_mono\nframe:  t265_imu\ntopics:/a/b,/c\ngpu(NVIDIA): GTX 1080\n\n"
      "seq:2\n#stamp,position:x,y,z\n5.5 1 2 3 0 0 0 1\n"
      "scene:home\nframe:t265_imu\nseq: 1\naided_reloc: true\n1.0 9.5 4 5 6 0 0 0.6 0.8\n");
  EXPECT_EQ(result.scene, "home");
  EXPECT_EQ(result.frame, "t265_imu");
  ASSERT_EQ(result.sequences.size(), 2U);
  EXPECT_EQ(result.sequences[0].number, 1);
  EXPECT_TRUE(result.sequences[0].aided);
  EXPECT_EQ(result.sequences[0].output_times, std::vector<double>{9.5});
  EXPECT_EQ(result.sequences[0].poses[0].world_from_camera.translation(), Eigen::Vector3d(4, 5, 6));
  EXPECT_NEAR(result.sequences[0].poses[0].world_from_camera.rotation().w(), 0.8, 1e-12);
  EXPECT_EQ(result.sequences[1].number, 2);
  EXPECT_FALSE(result.sequences[1].aided);
  EXPECT_TRUE(result.sequences[1].output_times.empty());
  EXPECT_DOUBLE_EQ(result.sequences[1].poses.at(0).stamp, 5.5);
}

TEST_F(OpenlorisResultFile, SortsRowsAndDropsThoseWithoutAPose) {
  const OpenlorisResult result = read(
      "scene: a\nframe: b\nseq: 1\n3 0 0 0 0 0 0 1\n2 nan 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n"
      "3 7 0 0 0 0 0 1\nseq: 2\n");
  ASSERT_EQ(result.sequences.size(), 2U);
  const Trajectory& poses = result.sequences[0].poses;
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[0].stamp, 1.0);
  EXPECT_EQ(poses[1].stamp, 3.0);
  EXPECT_EQ(poses[1].world_from_camera.translation().x(), 7.0);
  EXPECT_TRUE(result.sequences[1].poses.empty());
}

TEST_F(OpenlorisResultFile, RefusesWhatIsNoResult) {
  EXPECT_THAT(refusal("1 0 0 0 0 0 0 1\n"), HasSubstr(":1: a pose before the first"));
  EXPECT_THAT(refusal("frame: b\nseq: 1\n"), HasSubstr("no line \"scene: NAME\""));
  EXPECT_THAT(refusal("scene: a\nseq: 1\n"), HasSubstr("no line \"frame: NAME\""));
  EXPECT_THAT(refusal("scene: a\nframe: b\n"), HasSubstr("no line \"seq: N\""));
  EXPECT_THAT(refusal(""), HasSubstr("no line"));
  const std::string begin = "scene: a\nframe: b\nseq: 1\n";
  EXPECT_THAT(refusal(begin + "1 2 3\n"), HasSubstr(":4: 3 columns, expected 8 or 9"));
  EXPECT_THAT(refusal(begin + "1 0 0 0 0 0 0 2\n"), HasSubstr(":4: quaternion of length 2"));
  EXPECT_THAT(refusal(begin + "1 0 x 0 0 0 0 1\n"), HasSubstr("'x'"));
  EXPECT_THAT(refusal(begin + "nan 0 0 0 0 0 0 1\n"), HasSubstr("stamp"));
  EXPECT_THAT(refusal(begin + "seq: 1\n"), HasSubstr(":4: sequence 1 a second time"));
  EXPECT_THAT(refusal(begin + "seq: 1.5\n"), HasSubstr("'1.5', expected a whole number"));
  EXPECT_THAT(refusal(begin + "seq: -1\n"), HasSubstr("expected a whole number"));
  EXPECT_THAT(refusal(begin + "scene: c\n"), HasSubstr("scene is 'c' after 'a'"));
}

TEST_F(OpenlorisResultFile, ReadsBackWhatItWrote) {
  OpenlorisResult result;
  result.scene = "office";
  result.frame = "d400_color";
  const SE3 pose(Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5), Eigen::Vector3d(1.25, -2, 1e-3));
  result.sequences = {{1, false, {{1560000083.949067, pose}}, {1568975680.5}}, {4, true, {}, {}}};
  write_openloris_result(path_, result);
  const OpenlorisResult again = read_openloris_result(path_);
  EXPECT_EQ(again.scene, "office");
  EXPECT_EQ(again.frame, "d400_color");
  ASSERT_EQ(again.sequences.size(), 2U);
  EXPECT_NEAR(again.sequences[0].poses.at(0).stamp, 1560000083.949067, 1e-6);
  EXPECT_LT((again.sequences[0].poses[0].world_from_camera * pose.inverse()).log().norm(), 1e-8);
  EXPECT_EQ(again.sequences[0].output_times, std::vector<double>{1568975680.5});
  EXPECT_EQ(again.sequences[1].number, 4);
  EXPECT_TRUE(again.sequences[1].aided);

  std::swap(result.sequences[0], result.sequences[1]);
  EXPECT_THROW(write_openloris_result(path_, result), ContractError);
}

}  // namespace
}  // namespace dxslam
