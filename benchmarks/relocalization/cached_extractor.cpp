// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "cached_extractor.h"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <fstream>

namespace dxslam::benchmark {
namespace {

std::uint64_t hash_of(const cv::Mat& image) {
  std::uint64_t hash = 14695981039346656037ULL;  // FNV-1a
  for (int y = 0; y < image.rows; ++y) {
    const std::uint8_t* row = image.ptr(y);
    for (std::size_t x = 0; x < image.elemSize() * static_cast<std::size_t>(image.cols); ++x) {
      hash = (hash ^ row[x]) * 1099511628211ULL;
    }
  }
  return hash;
}

template <class T>
void put(std::ofstream& file, const T* values, std::size_t n) {
  file.write(reinterpret_cast<const char*>(values), static_cast<std::streamsize>(n * sizeof(T)));
}

template <class T>
void get(std::ifstream& file, T* values, std::size_t n) {
  file.read(reinterpret_cast<char*>(values), static_cast<std::streamsize>(n * sizeof(T)));
}

bool load(const std::string& path, Features& features) {
  std::ifstream file(path, std::ios::binary);
  int head[4] = {};
  get(file, head, 4);
  if (!file) return false;
  features.keypoints.resize(static_cast<std::size_t>(head[0]));
  features.descriptors.create(head[0], head[1], head[2]);
  features.global.resize(static_cast<std::size_t>(head[3]));
  get(file, features.keypoints.data(), features.keypoints.size());
  get(file, features.descriptors.data,
      features.descriptors.total() * features.descriptors.elemSize());
  get(file, features.global.data(), features.global.size());
  return static_cast<bool>(file);
}

void save(const std::string& path, const Features& features) {
  std::ofstream file(path, std::ios::binary);
  const cv::Mat descriptors = features.descriptors.clone();
  const int head[4] = {static_cast<int>(features.size()), descriptors.cols, descriptors.type(),
                       static_cast<int>(features.global.size())};
  put(file, head, 4);
  put(file, features.keypoints.data(), features.keypoints.size());
  put(file, descriptors.data, descriptors.total() * descriptors.elemSize());
  put(file, features.global.data(), features.global.size());
}

}  // namespace

CachedExtractor::CachedExtractor(std::unique_ptr<FeatureExtractor> extractor, std::string folder)
    : extractor_(std::move(extractor)), folder_(std::move(folder)) {
  std::filesystem::create_directories(folder_);
}

Features CachedExtractor::extract(const cv::Mat& image, bool) {
  const std::string path = fmt::format("{}/{:016x}", folder_, hash_of(image));
  Features features;
  if (load(path, features)) return features;
  features = extractor_->extract(image, true);
  save(path, features);
  return features;
}

}  // namespace dxslam::benchmark
