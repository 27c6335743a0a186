// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/calibration/calibration.h"

#include "io/primitives/test_folder.h"

namespace dxslam {
namespace {

TEST(Calibration, EveryPresetIsValidAndIsItsFile) {
  for (const std::string& name : camera_preset_names()) {
    EXPECT_NO_THROW(load_camera(name)) << name;
    const std::string file = DXSLAM_SOURCE_DIR "/calibration/" + name + ".yaml";
    std::ifstream stream(file);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), camera_preset_text(name));
  }
  EXPECT_THAT(camera_preset_names(),
              testing::IsSupersetOf({"tum_fr1", "tum_fr2", "tum_fr3", "seven_scenes",
                                     "openloris_d435i", "realsense_d435i"}));
}

TEST(Calibration, Freiburg1HasThePublishedValues) {
  const Camera camera = load_camera("tum_fr1");
  EXPECT_EQ(camera.fx, 517.306408);
  EXPECT_EQ(camera.cy, 255.313989);
  EXPECT_EQ(camera.lens.parameters[2], -0.005358);
  EXPECT_EQ(camera.lens.parameters[4], 1.163314);
  EXPECT_EQ(camera.depth_factor, 5000.0);
}

TEST(Calibration, DumpReadsBackToTheSame) {
  const Camera camera = load_camera("tum_fr2");
  const Camera again = parse_camera(dump_camera(camera, "A title"), "dump");
  EXPECT_EQ(again, camera);
  EXPECT_EQ(again.width, camera.width);
  EXPECT_EQ(dump_camera(again, "A title"), dump_camera(camera, "A title"));
}

TEST(Calibration, ReadsWhereTheDepthCameraIs) {
  const std::string depth =
      "depth_camera:\n  fx: 58\n  fy: 59\n  cx: 31\n  cy: 23\n  x: -0.025\n  rz: 0.01\n";
  const RgbdCalibration calibration = parse_calibration(test_calibration() + depth, "c.yaml");
  EXPECT_FALSE(calibration.depth_camera.registered());
  EXPECT_EQ(calibration.depth_camera.fy, 59.0);
  EXPECT_EQ(calibration.depth_camera.color_from_depth().translation().x(), -0.025);
  EXPECT_EQ(calibration.camera.fx, parse_camera(test_calibration(), "c.yaml").fx);
  EXPECT_TRUE(parse_calibration(test_calibration(), "c.yaml").depth_camera.registered());
}

TEST(Calibration, KnowsTheParametersOfEachLens) {
  const std::string good = test_calibration();
  for (const LensModel* model : lens_models()) {
    std::string yaml = good + "lens: " + model->name + "\n";
    Camera expected = parse_camera(good, "c.yaml");
    expected.lens = {model, {}};
    for (std::size_t i = 0; i < model->parameter_count(); ++i) {
      expected.lens.parameters[i] = 0.001 * static_cast<double>(i + 1);
      yaml += fmt::format("{}: {}\n", model->parameters[i], expected.lens.parameters[i]);
    }
    const Camera camera = parse_camera(yaml, "c.yaml");
    EXPECT_EQ(camera, expected) << model->name;
    EXPECT_EQ(parse_camera(dump_camera(camera, "again"), "again.yaml"), camera);
  }
  expect_input_error([&] { parse_camera(good + "lens: periscope\n", "c.yaml"); },
                     {"c.yaml: lens is 'periscope'", "double_sphere"});
  expect_input_error([&] { parse_camera(good + "lens: kannala_brandt\np1: 1\n", "c.yaml"); },
                     {"c.yaml:9", "p1"});
}

TEST(Calibration, RefusesHalfADepthCamera) {
  const std::string good = test_calibration();
  const auto refuse = [&](const std::string& text, const std::vector<std::string>& parts) {
    expect_input_error([&] { parse_calibration(good + text, "c.yaml"); }, parts);
  };
  refuse("depth_camera:\n  fx: 58\n  fy: 58\n  cx: 31\n", {"c.yaml", "depth_camera", "no cy"});
  refuse("depth_camera:\n  fx: 58\n  fy: 0\n  cx: 31\n  cy: 2\n", {"c.yaml", "fx 58 and fy 0"});
  refuse("depth_camera:\n  f: 58\n", {"c.yaml:9", "f"});
  refuse("depth_camera: 3\n", {"c.yaml:8", "depth_camera"});
}

TEST(Calibration, RefusesWhatCannotBeACamera) {
  const std::string good = test_calibration();
  EXPECT_NO_THROW(parse_camera(good, "c.yaml"));
  expect_input_error([&] { parse_camera(good + "k4: 1\n", "c.yaml"); }, {"c.yaml:8", "k4"});
  expect_input_error([&] { parse_camera(good + "fx: 1\n", "c.yaml"); }, {"c.yaml:8", "twice"});
  expect_input_error([&] { parse_camera(good + "fps: fast\n", "c.yaml"); }, {"c.yaml:8", "'fast'"});
  expect_input_error(
      [&] { parse_camera("width: 64\nheight: 48\nfx: 60\nfy: 60\ncx: 32\n", "c.yaml"); },
      {"c.yaml", "no cy"});
  expect_input_error([] { parse_camera("width: 64\nheight: 48\nfx: 6e9\n", "c.yaml"); },
                     {"c.yaml:3", "fx is '6e9'"});
  expect_input_error([] { load_camera("kinect"); }, {"'kinect'", "tum_fr1"});
  expect_input_error([] { load_camera("./none.yaml"); }, {"./none.yaml", "no such file"});
}

}  // namespace
}  // namespace dxslam
