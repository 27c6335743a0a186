// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>

namespace dxslam {

/// How descriptors lie in a file.
enum class DescriptorCoding : std::uint32_t {
  kBytes = 0,  ///< binary descriptors as they are
  /// Unit vectors in one signed byte per number: the largest number of a vector becomes 127. The
  /// length need not be stored, as it is 1. Coding what was decoded gives the same bytes, so saving
  /// again and again loses nothing more.
  kInt8 = 1,
  kFloat32 = 2,  ///< as they are
};

/// Bytes of one descriptor of `dimension` numbers.
std::size_t coded_size(DescriptorCoding coding, int dimension);

/// `values` to coded_size() bytes. The numbers must be finite.
void encode_descriptor(DescriptorCoding coding, const void* values, int dimension, char* coded);
/// And back: `dimension` floats, or bytes where kBytes.
void decode_descriptor(DescriptorCoding coding, const char* coded, int dimension, void* values);

}  // namespace dxslam
