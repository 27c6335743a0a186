// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace dxslam {

/// A camera in the dark, the model of this project's benchmarks: a grey value v of 0 to 255 becomes
/// x = gain * (v / 255)^2.2, then photon noise (Poisson, 400 photons at x = 1) and read noise
/// (Gaussian, sigma 0.006) are added, and 255 x is clipped to 0..255 and rounded down.
/// As there are only 256 grey values, the exact distribution of the outcome is tabulated for each
/// and one random number a pixel is drawn from it. Immutable; safe to share between threads.
class LowLight {
 public:
  static constexpr double kDefaultGain = 0.12;

  /// Throws InputError unless gain is in 0.001 to 1.
  explicit LowLight(double gain = kDefaultGain, std::uint64_t seed = 0);

  /// Darkened grey image (CV_8UC1) of a CV_8UC1 or CV_8UC3 (BGR) image. The noise depends on seed
  /// and frame index alone.
  cv::Mat apply(const cv::Mat& image, std::int64_t frame_index) const;

  /// Probability of each outcome for grey value `level`; sums to 1.
  static std::array<double, 256> distribution(int level, double gain);

 private:
  // Walker's alias method: outcome i with a probability of threshold / 2^24, else the alias.
  struct Cell {
    std::uint32_t threshold = 0;
    std::uint8_t alias = 0;
  };

  std::uint64_t seed_;
  std::vector<Cell> cells_;  // 256 rows of 256
};

}  // namespace dxslam
