// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/tum_writer.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "io/recordings/sequence_reader.h"
#include "synthetic/test_worlds.h"

namespace dxslam {
namespace {

namespace fs = std::filesystem;

class TumWriter : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    SyntheticOptions options = testing_worlds::quiet_room();
    options.frames = 5;
    options.factors.depth_noise = 1.0;
    sequence_ = new SyntheticSequence(options);
  }
  static void TearDownTestSuite() { delete sequence_; }
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("dxslam_synth_" + std::to_string(getpid()));
    fs::remove_all(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static SyntheticSequence* sequence_;
  fs::path folder_;
};
SyntheticSequence* TumWriter::sequence_ = nullptr;

TEST_F(TumWriter, WhatItWritesIsReadBackTheSame) {
  SyntheticSequence& sequence = *sequence_;
  TumWriterOptions writer;
  writer.png = true;
  ASSERT_TRUE(write_tum_sequence(sequence, folder_.string(), writer));
  const auto read = open_sequence(folder_.string());
  ASSERT_EQ(read->size(), sequence.size());
  EXPECT_EQ(read->camera().fx, sequence.camera().fx);
  EXPECT_EQ(read->camera().depth_factor, sequence.camera().depth_factor);
  ASSERT_EQ(read->ground_truth().size(), sequence.size());
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    const auto written = sequence.read(i), found = read->read(i);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->stamp, written->stamp, 1e-6);
    EXPECT_EQ(cv::norm(found->color, written->color, cv::NORM_INF), 0.0);
    EXPECT_LT(cv::norm(found->depth, written->depth, cv::NORM_INF), 1e-5);
    EXPECT_LT(translation_distance(read->ground_truth()[i].world_from_camera,
                                   sequence.ground_truth()[i].world_from_camera),
              1e-6);
  }
}

TEST_F(TumWriter, JpegIsCloseAndTheSceneIsDescribed) {
  SyntheticSequence& sequence = *sequence_;
  ASSERT_TRUE(write_tum_sequence(sequence, folder_.string(), {}));
  const auto read = open_sequence(folder_.string());
  const cv::Mat difference = read->read(2)->color - sequence.read(2)->color;
  EXPECT_LT(cv::mean(difference)[1], 3.0);
  const auto scene = nlohmann::json::parse(std::ifstream(folder_ / "scene.json"));
  EXPECT_EQ(scene["options"]["seed"], 1);
  EXPECT_EQ(scene["options"]["factors"]["depth_noise"], 1.0);
  EXPECT_EQ(scene["frames"], 5);
  EXPECT_NEAR(scene["path_length_m"].get<double>(), sequence.path_length(), 1e-9);
}

TEST_F(TumWriter, RefusesAFolderWithContentUnlessAskedToReplaceIt) {
  SyntheticSequence& sequence = *sequence_;
  fs::create_directories(folder_);
  std::ofstream(folder_ / "notes.md") << "mine";
  EXPECT_THROW(write_tum_sequence(sequence, folder_.string(), {}), InputError);
  EXPECT_THROW(require_usable_folder((folder_ / "notes.md").string(), true), InputError);
  TumWriterOptions writer;
  writer.overwrite = true;
  EXPECT_THROW(write_tum_sequence(sequence, folder_.string(), writer), InputError);
  fs::remove(folder_ / "notes.md");
  ASSERT_TRUE(write_tum_sequence(sequence, folder_.string(), writer));
  std::ofstream(folder_ / "notes.md") << "mine";
  ASSERT_TRUE(write_tum_sequence(sequence, folder_.string(), writer));
  EXPECT_TRUE(fs::exists(folder_ / "notes.md"));
  EXPECT_TRUE(fs::exists(folder_ / "rgb.txt"));
}

TEST_F(TumWriter, EmptiesNoFolderOfOthers) {
  SyntheticSequence& sequence = *sequence_;
  ASSERT_TRUE(write_tum_sequence(sequence, folder_.string(), {}));
  TumWriterOptions writer;
  writer.overwrite = true;
  std::ofstream(folder_ / "rgb" / "mine.png") << "mine";
  EXPECT_THROW(write_tum_sequence(sequence, folder_.string(), writer), InputError);
  EXPECT_TRUE(fs::exists(folder_ / "rgb.txt"));
  fs::remove(folder_ / "rgb" / "mine.png");
  // As a camera would have made it.
  std::ofstream(folder_ / "scene.json") << "{}";
  EXPECT_THROW(write_tum_sequence(sequence, folder_.string(), writer), InputError);
  fs::remove(folder_ / "scene.json");
  EXPECT_THROW(write_tum_sequence(sequence, folder_.string(), writer), InputError);
  ASSERT_EQ(::mkfifo((folder_ / "scene.json").c_str(), 0600), 0);  // which nobody writes to
  EXPECT_THROW(write_tum_sequence(sequence, folder_.string(), writer), InputError);
  EXPECT_EQ(open_sequence(folder_.string())->size(), sequence.size());
}

TEST_F(TumWriter, StopsWhenToldAndListsWhatWasDrawn) {
  SyntheticSequence& sequence = *sequence_;
  TumWriterOptions writer;
  writer.threads = 1;
  std::size_t calls = 0;
  writer.progress = [&calls](std::size_t done, std::size_t total) {
    EXPECT_EQ(done, ++calls);
    EXPECT_EQ(total, 5U);
    return done < 2;
  };
  EXPECT_FALSE(write_tum_sequence(sequence, folder_.string(), writer));
  EXPECT_EQ(calls, 2U);
  EXPECT_EQ(open_sequence(folder_.string())->size(), 2U);
  EXPECT_THROW(write_tum_sequence(sequence, "/proc/nowhere", {}), InputError);
}

}  // namespace
}  // namespace dxslam
