// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include "io/primitives/test_folder.h"
#include "io/recordings/sequence_reader.h"

namespace dxslam {
namespace {

// Five frames at 10 Hz; depth images 4 ms later, of 1 m times the frame number plus one.
void write_sequence(const TestFolder& folder) {
  std::string rgb = "# color\n\n";
  std::string depth = "# depth\r\n";
  std::string truth = "# truth\n";
  for (int i = 0; i < 5; ++i) {
    folder.write(fmt::format("rgb/{}.png", i), test_color());
    folder.write(fmt::format("depth/{}.png", i), test_depth(1000 * (i + 1)));
    rgb += fmt::format("{:.3f} rgb/{}.png\n", 0.1 * i, i);
    depth += fmt::format("{:.3f} depth/{}.png\r\n", 0.1 * i + 0.004, i);
    truth += fmt::format("{:.3f} {} 0 0 0 0 0 1\n", 0.1 * i, i);
  }
  folder.write("rgb.txt", rgb);
  folder.write("depth.txt", depth);
  folder.write("groundtruth.txt", truth);
  folder.write("calibration.yaml", test_calibration());
}

TEST(TumReader, ReadsFramesStampsDepthAndTruth) {
  const TestFolder folder;
  write_sequence(folder);
  const auto sequence = open_sequence(folder.path());
  EXPECT_EQ(sequence->name(), "sequence");
  ASSERT_EQ(sequence->size(), 5U);
  EXPECT_EQ(sequence->camera().fx, 60.0);
  EXPECT_DOUBLE_EQ(sequence->stamp(3), 0.3);
  const auto image = sequence->read(2);
  ASSERT_TRUE(image.has_value());
  EXPECT_EQ(image->index, 2);
  EXPECT_DOUBLE_EQ(image->stamp, 0.2);
  EXPECT_EQ(image->color.type(), CV_8UC3);
  ASSERT_EQ(image->depth.type(), CV_32FC1);
  EXPECT_FLOAT_EQ(image->depth.at<float>(10, 10), 3.0F);
  ASSERT_EQ(sequence->ground_truth().size(), 5U);
  EXPECT_EQ(sequence->ground_truth()[4].world_from_camera.translation().x(), 4.0);
  EXPECT_TRUE(sequence->skipped().empty());
  EXPECT_THROW(sequence->read(5), ContractError);
}

TEST(TumReader, TellsCalibrationAndDepth) {
  const TestFolder folder;
  write_sequence(folder);
  const cv::Mat half = test_depth(2000);
  half.rowRange(0, half.rows / 2) = 0;
  folder.write("depth/1.png", half);
  const auto sequence = open_sequence(folder.path());
  const RecordingFacts& facts = sequence->facts();
  EXPECT_THAT(facts.calibration_source, testing::HasSubstr("calibration.yaml"));
  EXPECT_TRUE(facts.has_depth);
  EXPECT_FLOAT_EQ(facts.median_depth, 2.0F);
  EXPECT_NEAR(facts.depth_share, 5.0 / 6.0, 1e-9);
  require_depth(*sequence);
}

TEST(TumReader, LeavesOutAndReportsFramesWithoutDepthNearby) {
  const TestFolder folder;
  write_sequence(folder);
  folder.write("depth.txt", "0.0 depth/0.png\n0.119 depth/1.png\n0.221 depth/2.png\n");
  auto sequence = open_sequence(folder.path());
  ASSERT_EQ(sequence->size(), 2U);
  EXPECT_DOUBLE_EQ(sequence->stamp(1), 0.1);
  ASSERT_EQ(sequence->skipped().size(), 3U);
  EXPECT_EQ(sequence->skipped()[0].index, 2U);
  EXPECT_THAT(sequence->skipped()[0].reason, testing::HasSubstr("0.021 s away"));

  SequenceOptions options;
  options.max_association_s = 0.03;
  EXPECT_EQ(open_sequence(folder.path(), options)->size(), 3U);
  options.max_association_s = -1.0;
  expect_input_error([&] { open_sequence(folder.path(), options); }, {"max_association_s is -1"});
}

TEST(TumReader, TakesAnAssociationFile) {
  const TestFolder folder;
  write_sequence(folder);
  SequenceOptions options;
  options.association = folder.write("pairs.txt",
                                     "0.1 rgb/1.png 0.204 depth/2.png\r\n# skip\n\n"
                                     "0.3 rgb/3.png 0.304 depth/3.png");
  const auto sequence = open_sequence(folder.path(), options);
  ASSERT_EQ(sequence->size(), 2U);
  EXPECT_FLOAT_EQ(sequence->read(0)->depth.at<float>(0, 0), 3.0F);

  folder.write("pairs.txt", "0.1 rgb/1.png 0.2\n");
  expect_input_error([&] { open_sequence(folder.path(), options); }, {"pairs.txt:1", "3 columns"});
  folder.write("pairs.txt", "0.1 rgb/1.png nan depth/1.png\n");
  expect_input_error([&] { open_sequence(folder.path(), options); }, {"pairs.txt:1", "'nan'"});
  folder.write("pairs.txt", "");
  expect_input_error([&] { open_sequence(folder.path(), options); }, {"pairs.txt", "empty"});
}

TEST(TumReader, RefusesBrokenLists) {
  const TestFolder folder;
  write_sequence(folder);
  const auto expect = [&](const std::string& list, const std::vector<std::string>& parts) {
    folder.write("rgb.txt", list);
    expect_input_error([&] { open_sequence(folder.path()); }, parts);
  };
  expect("# only a comment\n", {"rgb.txt", "empty list"});
  expect("0.0 rgb/0.png\nnan rgb/1.png\n", {"rgb.txt:2", "stamp is 'nan'", "finite"});
  expect("0.0 rgb/0.png\n0.1\n", {"rgb.txt:2", "1 columns", "expected 2"});
  expect("1e400 rgb/0.png\n", {"rgb.txt:1", "1e400"});
  expect(std::string("\x7f\x45\x4c\x46\0\0", 6), {"rgb.txt:1", "binary"});
  expect("5.0 rgb/0.png\n", {"within 0.02 s", "nearest 4.596 s"});
  expect("0 rgb/0.png\n1e300 rgb/0.png\n1 rgb/1.png\n", {"rgb.txt:3", "after 1e+300,"});
  // Seconds in one list, milliseconds in the other.
  expect("1305031102000 rgb/0.png\n1305031102033 rgb/1.png\n",
         {"within 0.02 s", "rgb.txt: stamps", "milliseconds"});
}

TEST(TumReader, TakesNamesWithBlanksAndCommas) {
  const TestFolder folder;
  write_sequence(folder);
  for (const char* name : {"my rgb/a b,c.png", "my rgb/ d  e.png", "it's.png"}) {
    folder.write(name, test_color());
  }
  folder.write("my depth/1.0 2.0.png", test_depth(2000));
  folder.write("rgb.txt",
               "0.0 my rgb/a b,c.png \r\n0.1,\"my rgb/ d  e.png\"\n0.2 it's.png\n"
               "0.3 no such.png\n");
  folder.write("depth.txt",
               "0.0 my depth/1.0 2.0.png\n0.1 \"my depth/1.0 2.0.png\"\n"
               "0.2 depth/0.png\n0.3 depth/0.png\n");
  const auto sequence = open_sequence(folder.path());
  ASSERT_EQ(sequence->size(), 4U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(sequence->read(i).has_value()) << i;
  EXPECT_FALSE(sequence->read(3).has_value());
  EXPECT_THAT(sequence->skipped().back().reason, testing::HasSubstr("no such.png: no such file"));
  folder.write("rgb.txt", "0.0 rgb/0.png 0.0 depth/0.png\n");
  expect_input_error([&] { open_sequence(folder.path()); }, {"rgb.txt:1", "4 columns, expected 2"});
}

TEST(TumReader, TakesNamesWithBlanksInAssociations) {
  const TestFolder folder;
  write_sequence(folder);
  folder.write("my rgb/1 2.png", test_color());
  folder.write("my depth/3 4.png", test_depth(2000));
  SequenceOptions options;
  options.association = folder.write("pairs.txt",
                                     "0.1 my rgb/1 2.png 0.2 my depth/3 4.png\n"
                                     "0.2 \"my rgb/1 2.png\" 0.2 \"my depth/3 4.png\"\n"
                                     "0.3 rgb/3.png 0.304 my depth/3 4.png\n"
                                     "0.3 rgb/3.png 0.304 depth/3.png\n");
  const auto sequence = open_sequence(folder.path(), options);
  ASSERT_EQ(sequence->size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto image = sequence->read(i);
    ASSERT_TRUE(image.has_value()) << i;
    EXPECT_FLOAT_EQ(image->depth.at<float>(0, 0), 2.0F);
  }
  ASSERT_EQ(sequence->skipped().size(), 1U);
  EXPECT_THAT(sequence->skipped()[0].reason, testing::HasSubstr("pairs.txt:4: stamp 0.3 was"));
  folder.write("pairs.txt", "0.1 my rgb/1 2.png 0.2 my depth/5.png\n");
  expect_input_error([&] { open_sequence(folder.path(), options); },
                     {"pairs.txt:1", "7 columns, expected 4", "quotes"});
}

TEST(TumReader, SkipsAndCountsRepeatedLines) {
  const TestFolder folder;
  write_sequence(folder);
  folder.write("rgb.txt", folder.read("rgb.txt") + "0.200 rgb/2.png\n0.400 rgb/4.png\n");
  folder.write("depth.txt", folder.read("depth.txt") + "0.404 depth/4.png\n");
  const auto sequence = open_sequence(folder.path());
  ASSERT_EQ(sequence->size(), 5U);
  ASSERT_EQ(sequence->skipped().size(), 2U);
  EXPECT_EQ(sequence->skipped()[0].index, 2U);
  EXPECT_THAT(sequence->skipped()[0].reason, testing::HasSubstr("rgb.txt:8: stamp 0.2 was"));
  EXPECT_THAT(
      sequence->facts().notes,
      testing::ElementsAre(testing::HasSubstr("lines of depth.txt that were left out: 1;")));
}

TEST(TumReader, NamesDecimalCommas) {
  const TestFolder folder;
  write_sequence(folder);
  folder.write("rgb.txt", "0,000 rgb/0.png\n0,100 rgb/1.png\n");
  expect_input_error([&] { open_sequence(folder.path()); },
                     {"rgb.txt:1", "'0,000' has a decimal comma", "decimal point"});
  write_sequence(folder);
  folder.write("groundtruth.txt", "0,0 0 0 0 0 0 0 1,0\n");
  EXPECT_THAT(open_sequence(folder.path())->facts().truth_problem,
              testing::HasSubstr("decimal commas"));
}

TEST(TumReader, GivesAHintAboutStampsThatAreNoSeconds) {
  const TestFolder folder;
  write_sequence(folder);
  folder.write("rgb.txt", "1403636579763 rgb/0.png\n1403636579813 rgb/1.png\n");
  folder.write("depth.txt", "1403636579763 depth/0.png\n1403636579813 depth/1.png\n");
  const auto sequence = open_sequence(folder.path());
  EXPECT_THAT(sequence->facts().notes,
              testing::ElementsAre(testing::HasSubstr("50 s apart: they look like milliseconds"),
                                   testing::HasSubstr("have no time in common")));
}

TEST(TumReader, RefusesStampsGoingBackwards) {
  const TestFolder folder;
  write_sequence(folder);
  folder.write("depth.txt", "0.1 depth/0.png\n\n0.05 depth/1.png\n");
  expect_input_error([&] { open_sequence(folder.path()); },
                     {"depth.txt:3", "0.05 after 0.1", "rising"});
}

TEST(TumReader, NeedsItsListsButNoTruth) {
  const TestFolder folder;
  write_sequence(folder);
  folder.write("groundtruth.txt", "0.0 0 0 0 0 0 0 2\n");
  const auto sequence = open_sequence(folder.path());
  EXPECT_TRUE(sequence->ground_truth().empty());
  EXPECT_THAT(sequence->facts().truth_problem, testing::HasSubstr("groundtruth.txt:1"));
  EXPECT_THAT(sequence->facts().notes, testing::ElementsAre(testing::HasSubstr("length 2")));
  expect_input_error([&] { load_ground_truth(folder.path()); }, {"groundtruth.txt:1", "length 2"});
  std::filesystem::remove(folder / "groundtruth.txt");
  EXPECT_TRUE(open_sequence(folder.path())->ground_truth().empty());
  std::filesystem::remove(folder / "depth.txt");
  expect_input_error([&] { open_sequence(folder.path()); }, {"depth.txt", "no such file"});
}

TEST(TumReader, SkipsAndReportsBadFrames) {
  const TestFolder folder;
  write_sequence(folder);
  folder.truncate("rgb/1.png", 500);
  folder.write("depth/2.png", cv::Mat(48, 64, CV_8UC1, cv::Scalar(9)));
  folder.write("depth/3.png", test_depth(1000, 32, 24));
  std::filesystem::remove(folder / "rgb/4.png");
  const auto sequence = open_sequence(folder.path());
  EXPECT_TRUE(sequence->read(0).has_value());
  const std::vector<std::vector<std::string>> expected = {
      {"rgb/1.png", "truncated PNG"},
      {"depth/2.png", "8-bit", "16-bit"},
      {"depth/3.png", "32x24", "expected 64x48", "calibration.yaml"},
      {"rgb/4.png", "no such file"}};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_FALSE(sequence->read(i + 1).has_value());
    ASSERT_EQ(sequence->skipped().size(), i + 1);
    EXPECT_EQ(sequence->skipped().back().index, i + 1);
    for (const std::string& part : expected[i]) {
      EXPECT_THAT(sequence->skipped().back().reason, testing::HasSubstr(part));
    }
  }
}

TEST(TumReader, RefusesARecordingWithoutAnyGoodFrame) {
  const TestFolder folder;
  write_sequence(folder);
  folder.write("calibration.yaml", "width: 640\nheight: 480\nfx: 500\nfy: 500\ncx: 320\ncy: 240\n");
  expect_input_error([&] { open_sequence(folder.path()); },
                     {"rgb/0.png", "64x48", "expected 640x480", "calibration.yaml"});
}

TEST(TumReader, RefusesAnImpossibleDepthFactor) {
  const TestFolder folder;
  write_sequence(folder);
  folder.write("calibration.yaml", test_calibration(1.0));
  expect_input_error([&] { open_sequence(folder.path()); },
                     {"2e+03 m", "depth_factor 1 of", "calibration.yaml", "0.05 to 30 m"});
  folder.write("calibration.yaml", test_calibration(100000.0));
  expect_input_error([&] { open_sequence(folder.path()); }, {"0.02 m", "depth_factor 100000"});
}

TEST(TumReader, FindsTheCalibration) {
  const TestFolder plain("office");
  write_sequence(plain);
  std::filesystem::rename(plain / "calibration.yaml", plain / "camera.yaml");
  EXPECT_EQ(open_sequence(plain.path())->camera().width, 64);
  std::filesystem::rename(plain / "camera.yaml", plain / "other.yaml");
  expect_input_error([&] { open_sequence(plain.path()); },
                     {"office", "no calibration", "freiburg1", "--calibration"});
  SequenceOptions options;
  options.calibration = plain / "other.yaml";
  EXPECT_EQ(open_sequence(plain.path(), options)->camera().width, 64);

  // The preset is found and is that of 640x480 images.
  for (const char* name : {"rgbd_dataset_freiburg2_desk", "fr2_desk", "tum_fr2", "TUM-FR2-x"}) {
    const TestFolder named(name);
    write_sequence(named);
    std::filesystem::remove(named / "calibration.yaml");
    expect_input_error([&] { open_sequence(named.path()); },
                       {"expected 640x480", "preset tum_fr2 (by the folder's name)"});
  }
  // 30 frames per second are no camera, nor is a name that has such letters somewhere.
  for (const char* name : {"d435_fr30", "fr30", "my_fr1_copy", "d435_fr1", "fr1", "freiburg12"}) {
    const TestFolder named(name);
    write_sequence(named);
    std::filesystem::remove(named / "calibration.yaml");
    const std::string expected = name == std::string("fr1") ? "preset tum_fr1" : "no calibration";
    expect_input_error([&] { open_sequence(named.path()); }, {expected});
  }
}

TEST(TumReader, SaysThatItGuessesTheCamera) {
  const TestFolder folder("fr3_desk");
  folder.write("rgb/0.png", test_color(640, 480));
  folder.write("depth/0.png", test_depth(5000, 640, 480));
  folder.write("rgb.txt", "0 rgb/0.png\n");
  folder.write("depth.txt", "0 depth/0.png\n");
  const auto sequence = open_sequence(folder.path());
  EXPECT_EQ(sequence->facts().calibration_source, "preset tum_fr3 (by the folder's name)");
  EXPECT_THAT(sequence->facts().notes,
              testing::ElementsAre(testing::HasSubstr("guessed from the folder's name")));
}

TEST(TumReader, ReadsTheRealRecording) {
  const std::string folder = shared_data("tum_fr1_rpy");
  if (folder.empty()) GTEST_SKIP() << "no shared data; set DXSLAM_SHARED";
  const auto sequence = open_sequence(folder);
  EXPECT_EQ(sequence->size() + sequence->skipped().size(), 200U);
  EXPECT_TRUE(sequence->camera().has_distortion());
  EXPECT_GT(sequence->ground_truth().size(), 1000U);
  const auto image = sequence->read(100);
  ASSERT_TRUE(image.has_value());
  EXPECT_EQ(image->color.size(), cv::Size(640, 480));
  EXPECT_GT(cv::countNonZero(image->depth), 100000);
}

}  // namespace
}  // namespace dxslam
