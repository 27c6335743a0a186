// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/low_light.h"

#include <fmt/format.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/split_mix.h"

namespace dxslam {
namespace {

constexpr double kGamma = 2.2;
constexpr double kPhotons = 400.0;    // at full scale
constexpr double kReadNoise = 0.006;  // of full scale
constexpr int kLevels = 256;
constexpr double kFraction = 16777216.0;  // 2^24, what a random number leaves besides the column

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

// Adds weight * P(outcome j | k photons) for all j. The read noise reaches few neighbours.
void add_photon_count(int k, double weight, std::array<double, kLevels>& outcome) {
  const double mean = k / kPhotons;
  const double reach = 8.0 * kReadNoise;
  const int first = std::clamp(static_cast<int>((mean - reach) * 255.0), 0, kLevels - 1);
  const int last = std::clamp(static_cast<int>((mean + reach) * 255.0) + 1, 0, kLevels - 1);
  double below = 0.0;  // P(x < lower edge of j), with all that is clipped to 0 in the first
  for (int j = first; j <= last; ++j) {
    const double upper = j == last ? 1.0 : normal_cdf(((j + 1) / 255.0 - mean) / kReadNoise);
    outcome[static_cast<std::size_t>(j)] += weight * (upper - below);
    below = upper;
  }
}

}  // namespace

std::array<double, kLevels> LowLight::distribution(int level, double gain) {
  std::array<double, kLevels> outcome{};
  const double photons = kPhotons * gain * std::pow(level / 255.0, kGamma);
  const int most = static_cast<int>(photons + 10.0 * std::sqrt(photons) + 20.0);
  double total = 0.0;
  for (int k = 0; k <= most; ++k) {
    const double log_weight = photons > 0.0 ? k * std::log(photons) - photons - std::lgamma(k + 1.0)
                                            : (k == 0 ? 0 : -1e9);
    const double weight = std::exp(log_weight);
    if (weight < 1e-12) continue;
    add_photon_count(k, weight, outcome);
    total += weight;
  }
  for (double& probability : outcome) probability /= total;
  return outcome;
}

LowLight::LowLight(double gain, std::uint64_t seed) : seed_(seed), cells_(kLevels * kLevels) {
  if (!(gain >= 0.001 && gain <= 1.0)) {
    throw InputError(fmt::format("low-light gain is {}, expected 0.001 to 1", gain));
  }
  for (int level = 0; level < kLevels; ++level) {
    std::array<double, kLevels> share = distribution(level, gain);
    std::vector<int> small;
    std::vector<int> large;
    for (int j = 0; j < kLevels; ++j) {
      share[static_cast<std::size_t>(j)] *= kLevels;
      (share[static_cast<std::size_t>(j)] < 1.0 ? small : large).push_back(j);
    }
    Cell* row = &cells_[static_cast<std::size_t>(level) * kLevels];
    while (!small.empty() && !large.empty()) {
      const auto poor = static_cast<std::size_t>(small.back());
      const auto rich = static_cast<std::size_t>(large.back());
      small.pop_back();
      row[poor] = {static_cast<std::uint32_t>(share[poor] * kFraction),
                   static_cast<std::uint8_t>(rich)};
      share[rich] -= 1.0 - share[poor];
      if (share[rich] >= 1.0) continue;
      large.pop_back();
      small.push_back(static_cast<int>(rich));
    }
    // What is left has a share of 1 up to rounding.
    for (const auto& rest : {small, large}) {
      for (const int j : rest) {
        row[j] = {static_cast<std::uint32_t>(kFraction), static_cast<std::uint8_t>(j)};
      }
    }
  }
}

cv::Mat LowLight::apply(const cv::Mat& image, std::int64_t frame_index) const {
  require(image.type() == CV_8UC1 || image.type() == CV_8UC3, "low light needs an 8-bit image");
  cv::Mat grey = image;
  if (image.channels() == 3) cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  cv::Mat dark(grey.size(), CV_8UC1);
  // Any frame's noise can be made without that of the frames before it.
  SplitMix64 start(seed_ * 0xD1342543DE82EF95ULL + static_cast<std::uint64_t>(frame_index));
  SplitMix64 random(start.bits());
  for (int y = 0; y < grey.rows; ++y) {
    const std::uint8_t* in = grey.ptr(y);
    std::uint8_t* out = dark.ptr(y);
    std::uint64_t bits = 0;
    for (int x = 0; x < grey.cols; ++x) {
      bits = x % 2 == 0 ? random.bits() : bits >> 32U;
      const auto column = static_cast<std::uint32_t>(bits & 0xFFU);
      const auto fraction = static_cast<std::uint32_t>(bits & 0xFFFFFF00U) >> 8U;
      const Cell& cell = cells_[std::size_t{in[x]} * kLevels + column];
      out[x] = fraction < cell.threshold ? static_cast<std::uint8_t>(column) : cell.alias;
    }
  }
  return dark;
}

}  // namespace dxslam
