// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <random>

#include "core/se3.h"
#include "io/primitives/test_folder.h"
#include "io/recordings/sequence_reader.h"

namespace dxslam {
namespace {

constexpr const char* kSensors = R"(%YAML:1.0
---
d400_depth_optical_frame:
   sensor_type: depth
d400_color_optical_frame:
   sensor_type: camera
   fps: 30
   width: 64
   height: 48
   model: pinhole
   intrinsics: !!opencv-matrix
      rows: 1
      cols: 4
      dt: d
      data: [ 6.1e+01, 3.15e+01, 6.2e+01,
          2.35e+01 ]
   distortion_model: radial-tangential
   distortion_coefficients: !!opencv-matrix
      rows: 1
      cols: 5
      dt: d
      data: [ 0., 0., 0.001, 0., 0. ]
)";

// The camera 1 m above base_link, looking along its x axis.
constexpr const char* kTransforms = R"(%YAML:1.0
---
trans_matrix:
   -
      parent_frame: base_link
      child_frame: laser
      matrix: !!opencv-matrix
         rows: 4
         cols: 4
         dt: d
         data: [ 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1. ]
   -
      parent_frame: base_link
      child_frame: d400_color_optical_frame
      matrix: !!opencv-matrix
         rows: 4
         cols: 4
         dt: d
         data: [ 0., 0., 1., 0.2, -1., 0., 0., 0., 0., -1., 0., 1., 0., 0., 0., 1. ]
)";

void write_sequence(const TestFolder& folder) {
  std::string color;
  std::string depth;
  for (int i = 0; i < 3; ++i) {
    folder.write(fmt::format("color/{}.png", i), test_color());
    folder.write(fmt::format("aligned_depth/{}.png", i), test_depth(2500));
    color += fmt::format("{:.6f} color/{}.png\n", 1560000000.0 + 0.1 * i, i);
    depth += fmt::format("{:.6f} aligned_depth/{}.png\n", 1560000000.0 + 0.1 * i, i);
  }
  folder.write("color.txt", color);
  folder.write("aligned_depth.txt", depth);
  folder.write("sensors.yaml", kSensors);
  folder.write("trans_matrix.yaml", kTransforms);
  // The robot at (3, 0, 0), turned to the left by 90 degrees.
  folder.write("groundtruth.txt",
               "#Time px py pz qx qy qz qw\n"
               "1560000000.0 3 0 0 0 0 0.70710678 0.70710678\n");
}

TEST(OpenLorisReader, ReadsCalibrationAndMovesTheTruthToTheCamera) {
  const TestFolder folder("office1-1");
  write_sequence(folder);
  const auto sequence = open_sequence(folder.path());
  ASSERT_EQ(sequence->size(), 3U);
  EXPECT_EQ(sequence->camera().fx, 61.0);
  EXPECT_EQ(sequence->camera().fy, 62.0);
  EXPECT_EQ(sequence->camera().cx, 31.5);
  EXPECT_EQ(sequence->camera().lens.parameters[2], 0.001);
  EXPECT_EQ(sequence->camera().depth_baseline, 0.05);
  EXPECT_FLOAT_EQ(sequence->read(1)->depth.at<float>(3, 3), 2.5F);
  ASSERT_EQ(sequence->ground_truth().size(), 1U);
  const SE3& camera = sequence->ground_truth()[0].world_from_camera;
  EXPECT_LT((camera.translation() - Eigen::Vector3d(3.0, 0.2, 1.0)).norm(), 1e-6);
  // It looks along the robot's x axis, which is the world's y axis.
  EXPECT_LT((camera.rotation() * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitY()).norm(), 1e-6);
}

TEST(OpenLorisReader, FallsBackToThePublishedExtrinsicsOfTheRobot) {
  for (const std::string name : {"home1-2", "market1-1"}) {
    const TestFolder folder(name);
    write_sequence(folder);
    std::filesystem::remove(folder / "trans_matrix.yaml");
    const auto sequence = open_sequence(folder.path());
    const double height = sequence->ground_truth()[0].world_from_camera.translation().z();
    EXPECT_NEAR(height, name == "home1-2" ? 0.916 : 1.1985, 1e-3) << name;
  }
}

TEST(OpenLorisReader, NeedsSensorsForTheMarketOnly) {
  const TestFolder market("market1-1");
  write_sequence(market);
  std::filesystem::remove(market / "sensors.yaml");
  expect_input_error([&] { open_sequence(market.path()); },
                     {"market", "sensors.yaml", "--calibration"});
  const TestFolder office("office1-1");
  write_sequence(office);
  std::filesystem::remove(office / "sensors.yaml");
  expect_input_error([&] { open_sequence(office.path()); },
                     {"expected 848x480", "preset openloris_d435i"});
}

TEST(OpenLorisReader, RefusesBrokenCalibration) {
  const TestFolder folder("office1-1");
  write_sequence(folder);
  const auto expect = [&](const std::string& text, const std::vector<std::string>& parts) {
    folder.write("sensors.yaml", text);
    expect_input_error([&] { open_sequence(folder.path()); }, parts);
  };
  expect("%YAML:1.0\n---\nimu: 1\n", {"sensors.yaml", "no sensor d400_color_optical_frame"});
  expect("d400_color_optical_frame: [\n", {"sensors.yaml:", "not valid YAML"});
  expect("d400_color_optical_frame:\n  width: 64\n", {"sensors.yaml", "intrinsics", "4 finite"});
  expect("d400_color_optical_frame:\n  intrinsics:\n    data: [1, 2, .nan, 4]\n",
         {"sensors.yaml", "intrinsics", "4 finite"});
  expect("d400_color_optical_frame:\n  intrinsics:\n    data: [1, 2, 3, 4]\n",
         {"sensors.yaml", "width"});
  write_sequence(folder);
  folder.write("trans_matrix.yaml", "trans_matrix: 3\n");
  EXPECT_TRUE(open_sequence(folder.path())->ground_truth().empty());
  EXPECT_THAT(open_sequence(folder.path())->facts().truth_problem,
              testing::HasSubstr("trans_matrix.yaml: no list"));
}

TEST(OpenLorisReader, SurvivesRandomDamageOfItsCalibration) {
  const TestFolder folder("office1-1");
  write_sequence(folder);
  std::mt19937 random(13);
  int refused = 0;
  for (int i = 0; i < 400; ++i) {
    const bool sensors = i % 2 == 0;
    std::string text = sensors ? kSensors : kTransforms;
    for (int k = 0; k < 3; ++k) text[random() % text.size()] = "\n: []{}&*!-.5x"[random() % 15];
    folder.write(sensors ? "sensors.yaml" : "trans_matrix.yaml", text);
    try {
      open_sequence(folder.path());
    } catch (const InputError&) {
      ++refused;
    }
    folder.write("sensors.yaml", kSensors);
    folder.write("trans_matrix.yaml", kTransforms);
  }
  EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace dxslam
