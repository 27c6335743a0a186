// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map_files/descriptor_coding.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "core/random_unit.h"

namespace dxslam {
namespace {

double dot(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(a[i]) * b[i];
  return sum;
}

std::vector<float> decoded(const std::string& coded, int dimension) {
  std::vector<float> v(static_cast<std::size_t>(dimension));
  decode_descriptor(DescriptorCoding::kInt8, coded.data(), dimension, v.data());
  return v;
}

TEST(DescriptorCoding, KeepsUnitVectorsInOneByteANumber) {
  std::mt19937 random(3);
  for (const int dimension : {1, 32, 64, 256, 4096}) {
    for (int i = 0; i < 50; ++i) {
      const std::vector<float> v = random_unit(random, static_cast<std::size_t>(dimension));
      std::string coded(coded_size(DescriptorCoding::kInt8, dimension), '\0');
      ASSERT_EQ(coded.size(), static_cast<std::size_t>(dimension));
      encode_descriptor(DescriptorCoding::kInt8, v.data(), dimension, coded.data());
      const std::vector<float> back = decoded(coded, dimension);
      EXPECT_NEAR(dot(back, back), 1.0, 1e-5);
      EXPECT_GT(dot(v, back), 0.9998);
    }
  }
}

TEST(DescriptorCoding, LosesNothingWhenDoneAgain) {
  std::mt19937 random(4);
  for (int i = 0; i < 500; ++i) {
    const std::vector<float> v = random_unit(random, 64);
    std::string first(64, '\0');
    encode_descriptor(DescriptorCoding::kInt8, v.data(), 64, first.data());
    std::string second(64, '\0');
    encode_descriptor(DescriptorCoding::kInt8, decoded(first, 64).data(), 64, second.data());
    ASSERT_EQ(first, second);
  }
}

TEST(DescriptorCoding, TakesVectorsOfZeros) {
  const std::vector<float> zeros(8, 0.0F);
  std::string coded(8, 'x');
  encode_descriptor(DescriptorCoding::kInt8, zeros.data(), 8, coded.data());
  EXPECT_EQ(decoded(coded, 8), zeros);
}

TEST(DescriptorCoding, KeepsBytesAndFloatsAsTheyAre) {
  const std::vector<float> v = {1.5F, -2.0F, 1e-20F};
  std::string coded(coded_size(DescriptorCoding::kFloat32, 3), '\0');
  encode_descriptor(DescriptorCoding::kFloat32, v.data(), 3, coded.data());
  std::vector<float> back(3);
  decode_descriptor(DescriptorCoding::kFloat32, coded.data(), 3, back.data());
  EXPECT_EQ(back, v);
  EXPECT_EQ(coded_size(DescriptorCoding::kBytes, 32), 32U);
}

}  // namespace
}  // namespace dxslam
