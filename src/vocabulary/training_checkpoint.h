// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace dxslam {

/// All that a training of a vocabulary needs to go on after an interruption.
struct TrainingCheckpoint {
  std::string source;          ///< what is trained from what, see VocabularyTrainer::save
  std::uint64_t position = 0;  ///< the caller's count of images
  std::uint64_t images = 0;
  std::vector<float> sums;
  std::vector<float> totals;
  std::vector<std::uint32_t> last_words;
  cv::Mat last_descriptors;
  std::vector<cv::Mat> sample;
  std::uint64_t sample_stride = 1;
  std::uint64_t sample_offered = 0;
};

/// The bytes of a checkpoint file, with a checksum.
std::string format_checkpoint(const TrainingCheckpoint& state);

/// Descriptors must be of this type and dimension. Throws InputError if the file cannot be read or
/// is no whole checkpoint of such descriptors.
TrainingCheckpoint read_checkpoint(const std::string& path, int type, int dimension);

}  // namespace dxslam
