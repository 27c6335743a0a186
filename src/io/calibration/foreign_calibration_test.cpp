// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/calibration/foreign_calibration.h"

#include <gtest/gtest.h>

#include "io/calibration/calibration.h"
#include "io/primitives/test_folder.h"

namespace dxslam {
namespace {

Camera parse(const std::string& yaml) { return parse_calibration(yaml, "c.yaml").camera; }

TEST(ForeignCalibration, OfOrbSlam) {
  const std::string pinhole = R"(%YAML:1.0
---
Camera.type: "PinHole"
Camera.fx: 517.306408
Camera.fy: 516.469215
Camera.cx: 318.643040
Camera.cy: 255.313989
Camera.k1: 0.262383
Camera.k2: -0.953104
Camera.p1: -0.005358
Camera.p2: 0.002628
Camera.k3: 1.163314
Camera.width: 640
Camera.height: 480
Camera.fps: 30.0
Camera.bf: 40.0
Camera.RGB: 1
ThDepth: 40.0
DepthMapFactor: 5000.0
ORBextractor.nFeatures: 1000
)";
  const Camera camera = parse(pinhole);
  EXPECT_EQ(camera.fx, 517.306408);
  EXPECT_EQ(camera.depth_factor, 5000.0);
  EXPECT_EQ(camera.lens, load_camera("tum_fr1").lens);
  const std::string fisheye = R"(%YAML:1.0
File.version: "1.0"
Camera.type: "KannalaBrandt8"
Camera1.fx: 190.97847715128717
Camera1.fy: 190.9733070521226
Camera1.cx: 254.93170605935475
Camera1.cy: 256.8974428996504
Camera1.k1: 0.0034823894022493434
Camera1.k2: 0.0007150348452162257
Camera1.k3: -0.0020532361418706202
Camera1.k4: 0.00020293673591811182
Camera.width: 512
Camera.height: 512
Camera.fps: 20
RGBD.DepthMapFactor: 1000.0
)";
  EXPECT_EQ(parse(fisheye).lens.model, &kKannalaBrandt);
  EXPECT_EQ(parse(fisheye).lens.parameters[3], 0.00020293673591811182);
  EXPECT_EQ(parse(fisheye).fps, 20.0);
  std::string without_size = pinhole;
  without_size.replace(without_size.find("Camera.width"), 12, "Camera.worth");
  expect_input_error([&] { parse(without_size); }, {"c.yaml: no image size", "Camera.width"});
  std::string other = fisheye;
  other.replace(other.find("KannalaBrandt8"), 14, "MysteryBrandt8");
  expect_input_error([&] { parse(other); }, {"c.yaml", "'MysteryBrandt8'", "PinHole"});
}

TEST(ForeignCalibration, OfRos) {
  const Camera file = parse(R"(image_width: 640
image_height: 480
camera_name: head_camera
camera_matrix:
  rows: 3
  cols: 3
  data: [520.5, 0, 321.25, 0, 521.5, 243.75, 0, 0, 1]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [0.1, -0.2, 0.001, -0.002, 0]
rectification_matrix: {rows: 3, cols: 3, data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}
)");
  EXPECT_EQ(file.cy, 243.75);
  EXPECT_EQ(file.lens.parameters[3], -0.002);
  const Camera message = parse(R"(header: {frame_id: camera}
height: 720
width: 1280
distortion_model: rational_polynomial
d: [0.5, -2.0, 0.0, 0.0, 1.0, 0.4, -1.9, 1.0]
k: [600.0, 0.0, 640.0, 0.0, 601.0, 360.0, 0.0, 0.0, 1.0]
p: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]
)");
  EXPECT_EQ(message.lens.model, &kRational);
  EXPECT_EQ(message.lens.parameters[7], 1.0);
  EXPECT_EQ(message.fy, 601.0);
  EXPECT_EQ(lens_from_ros("plumb_bob", {0, 0, 0, 0, 0}, "x"), Lens());
  EXPECT_EQ(lens_from_ros("", {}, "x"), Lens());
  EXPECT_EQ(lens_from_ros("None", {0, 0}, "x"), Lens());
  EXPECT_EQ(lens_from_ros("Inverse Brown Conrady", {0, 0, 0, 0, 0}, "x"), Lens());
  EXPECT_EQ(lens_from_ros("Kannala Brandt4", {1, 0, 0, 0}, "x").model, &kKannalaBrandt);
  EXPECT_EQ(lens_from_ros("equidistant", {0, 0, 0, 0}, "x").model, &kKannalaBrandt);
  expect_input_error([] { lens_from_ros("plumb_bob", {0, 0, 0, 0, 0, 1}, "x"); },
                     {"x: 6 numbers", "at most 5"});
  expect_input_error([] { lens_from_ros("fov", {1}, "x"); }, {"x: ", "'fov'", "plumb_bob"});
  expect_input_error([] { parse("camera_matrix: {data: [1, 2]}\n"); },
                     {"c.yaml: camera_matrix is no list of at least 9"});
}

TEST(ForeignCalibration, OfKalibr) {
  const Camera radtan = parse(R"(cam0:
  camera_model: pinhole
  distortion_coeffs: [-0.28, 0.07, 0.0002, 0.00002]
  distortion_model: radtan
  intrinsics: [458.6, 457.3, 367.2, 248.4]
  resolution: [752, 480]
  rostopic: /cam0/image_raw
)");
  EXPECT_EQ(radtan.width, 752);
  EXPECT_EQ(radtan.lens.parameters[0], -0.28);
  const Camera sphere = parse(R"(cam0:
  camera_model: ds
  distortion_coeffs: []
  distortion_model: none
  intrinsics: [-0.2, 0.59, 157.0, 157.1, 254.0, 256.0]
  resolution: [512, 512]
)");
  expect_input_error([] { parse("cam0: {camera_model: ds}\ncam1: {camera_model: ds}\n"); },
                     {"c.yaml: a camchain of several cameras"});
  EXPECT_EQ(sphere.lens.model, &kDoubleSphere);
  EXPECT_EQ(sphere.lens.parameters[1], 0.59);
  EXPECT_EQ(sphere.cx, 254.0);
  expect_input_error([] { parse("cam0: {camera_model: omni, resolution: [5, 5]}\n"); },
                     {"c.yaml: cam0", "'omni'", "pinhole or ds"});
}

}  // namespace
}  // namespace dxslam
