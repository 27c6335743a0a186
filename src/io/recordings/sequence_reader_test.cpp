// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/recordings/sequence_reader.h"

#include <random>

#include "io/primitives/test_folder.h"

namespace dxslam {
namespace {

TEST(SequenceReader, SaysWhatItLookedFor) {
  const TestFolder folder("nothing");
  expect_input_error([&] { open_sequence(folder.path()); },
                     {"nothing", "rgb.txt", "frame-NNNNNN", "aligned_depth.txt", "images/"});
  expect_input_error([&] { open_sequence(folder / "none"); }, {"none", "no such file or folder"});
  expect_input_error([&] { open_sequence(folder.write("file", "x")); },
                     {"file", "not a recording", ".mcap"});
}

TEST(SequenceReader, TakesTheOnlyRecordingInASubfolder) {
  const TestFolder folder("scene");
  folder.write("readme.txt", "x");
  folder.write("thumbnails/1.png", test_color());
  folder.write("seq-01/frame-000001.color.png", test_color(640, 480));
  folder.write("seq-01/frame-000001.depth.png", test_depth(1000, 640, 480));
  const auto sequence = open_sequence(folder.path());
  EXPECT_EQ(sequence->name(), "seq-01");
  EXPECT_THAT(sequence->facts().notes, testing::ElementsAre(testing::HasSubstr("seq-01 is used")));
  SequenceOptions options;
  options.format = "7scenes";
  EXPECT_EQ(open_sequence(folder.path(), options)->name(), "seq-01");
  options.format = "tum";
  expect_input_error([&] { open_sequence(folder.path(), options); }, {"rgb.txt", "no such file"});
  folder.write("seq-02/frame-000001.color.png", test_color(640, 480));
  folder.write("seq-10/frame-000001.color.png", test_color(640, 480));
  expect_input_error([&] { open_sequence(folder.path()); },
                     {"3 of its subfolders are (seq-01 and seq-02, ...)", "expected one of them"});
}

TEST(SequenceReader, RefusesOptionsThatAFormatDoesNotUse) {
  const TestFolder folder;
  folder.write("images/1.png", test_color());
  folder.write("calibration.yaml", test_calibration());
  SequenceOptions options;
  options.association = "/nonexistent";
  expect_input_error([&] { open_sequence(folder.path(), options); },
                     {"--association", "tum, openloris", "format folder"});
  options.association.clear();
  options.eye = "left";
  expect_input_error([&] { open_sequence(folder.path(), options); }, {"--eye", "format folder"});
}

TEST(SequenceReader, RefusesAmbiguousFoldersAndUnknownFormats) {
  const TestFolder folder;
  folder.write("rgb.txt", "");
  folder.write("color.txt", "");
  expect_input_error([&] { open_sequence(folder.path()); }, {"tum", "openloris", "--format"});
  SequenceOptions options;
  options.format = "openloris";
  expect_input_error([&] { open_sequence(folder.path(), options); }, {"color.txt", "empty list"});
  options.format = "euroc";
  expect_input_error([&] { open_sequence(folder.path(), options); },
                     {"'euroc'", "auto, tum, 7scenes, openloris, kitti, folder, bag, images"});
}

TEST(SequenceReader, LoadsTheTruthOfAFileOrAFolder) {
  const TestFolder folder;
  folder.write("images/1.png", test_color());
  folder.write("calibration.yaml", test_calibration());
  expect_input_error([&] { load_ground_truth(folder.path()); }, {"no true trajectory"});
  folder.write("poses.txt", "1 0 0 7 0 1 0 0 0 0 1 0 0 0 0 1\n");
  EXPECT_EQ(load_ground_truth(folder.path()).poses.at(0).world_from_camera.translation().x(), 7.0);
  const std::string file = folder.write("t.txt", "0 8 0 0 0 0 0 1\n");
  EXPECT_EQ(load_ground_truth(file).poses.at(0).world_from_camera.translation().x(), 8.0);
}

// Damaged lists and calibrations end in an InputError or a usable sequence, in nothing else.
TEST(SequenceReader, SurvivesRandomDamageOfItsTextFiles) {
  const TestFolder folder;
  folder.write("a.png", test_color());
  folder.write("d.png", test_depth(1000));
  const std::vector<std::pair<std::string, std::string>> files = {
      {"rgb.txt", "# c\n1.0 a.png\n2.0 a.png\n"},
      {"depth.txt", "1.0 d.png\n2.0 d.png\n"},
      {"groundtruth.txt", "1.0 0 0 0 0 0 0 1\n"},
      {"calibration.yaml", test_calibration()}};
  for (const auto& [name, text] : files) folder.write(name, text);
  ASSERT_EQ(open_sequence(folder.path())->size(), 2U);
  std::mt19937 random(11);
  int refused = 0;
  for (int i = 0; i < 600; ++i) {
    const auto& [name, text] = files[random() % files.size()];
    std::string damaged = text;
    for (int k = 0; k < 2; ++k) {
      damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
    }
    damaged.resize(damaged.size() - random() % 3);
    folder.write(name, damaged);
    try {
      open_sequence(folder.path())->read(0);
    } catch (const InputError&) {
      ++refused;
    }
    folder.write(name, text);
  }
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace dxslam
