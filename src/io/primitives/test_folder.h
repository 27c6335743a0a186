// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

// For tests only: temporary folders with files, and checks of what errors say.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/primitives/image_file.h"

namespace dxslam {

/// A new folder below the system's temporary folder, removed with all in it at the end.
class TestFolder {
 public:
  explicit TestFolder(const std::string& name = "sequence")
      : root_(std::filesystem::temp_directory_path() /
              ("dxslam_test_" + std::to_string(::getpid()) + "_" + std::to_string(counter()++))),
        path_(root_ / name) {
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() { std::filesystem::remove_all(root_); }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  std::string path() const { return path_.string(); }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

  std::string write(const std::string& name, const std::string& bytes) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return *this / name;
  }
  std::string write(const std::string& name, const cv::Mat& image) const {
    return write(name, encode_image(name, image));
  }
  void truncate(const std::string& name, std::uintmax_t bytes) const {
    std::filesystem::resize_file(path_ / name, bytes);
  }
  std::string read(const std::string& name) const {
    std::ifstream file(path_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  static int& counter() {
    static int value = 0;
    return value;
  }
  std::filesystem::path root_;
  std::filesystem::path path_;
};

/// The text of the InputError that `action` throws; a test failure and "" if it throws none.
template <class Action>
std::string input_error(Action action) {
  try {
    action();
  } catch (const InputError& e) {
    return e.what();
  }
  ADD_FAILURE() << "no InputError was thrown";
  return "";
}

/// Expects an InputError whose text holds all of these.
template <class Action>
void expect_input_error(Action action, const std::vector<std::string>& parts) {
  const std::string text = input_error(action);
  for (const std::string& part : parts) EXPECT_THAT(text, testing::HasSubstr(part));
}

/// A colour picture with some content and a depth picture of one raw value.
inline cv::Mat test_color(int width = 64, int height = 48) {
  cv::Mat image(height, width, CV_8UC3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.at<cv::Vec3b>(y, x) =
          cv::Vec3b(static_cast<std::uint8_t>(x * 3), static_cast<std::uint8_t>(y * 5),
                    static_cast<std::uint8_t>(x * y));
    }
  }
  return image;
}
inline cv::Mat test_depth(int raw, int width = 64, int height = 48) {
  return {height, width, CV_16UC1, cv::Scalar(raw)};
}

/// A camera file for the pictures above.
inline std::string test_calibration(double depth_factor = 1000.0) {
  return "width: 64\nheight: 48\nfx: 60\nfy: 60\ncx: 32\ncy: 24\ndepth_factor: " +
         std::to_string(depth_factor) + "\n";
}

/// The folder of real data, or nothing where it is absent: then tests skip.
inline std::string shared_data(const std::string& name) {
  const char* shared = std::getenv("DXSLAM_SHARED");
  const std::filesystem::path root =
      shared != nullptr ? std::filesystem::path(shared)
                        : std::filesystem::path(DXSLAM_SOURCE_DIR) / ".." / "shared";
  const std::filesystem::path folder = root / "data" / name;
  return std::filesystem::exists(folder) ? folder.string() : std::string();
}

}  // namespace dxslam
