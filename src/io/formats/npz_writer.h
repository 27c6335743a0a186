// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "io/primitives/output_file.h"

namespace dxslam {

/// Collects named arrays and writes them as a NumPy archive that numpy.load reads: a zip file of
/// uncompressed .npy members. Arrays are C-ordered; `shape` may be empty (a scalar). Names must be
/// new and without '/'. Up to 4 GiB in all; throws ContractError beyond and for sizes that differ
/// from the shape.
class NpzWriter {
 public:
  void add(const std::string& name, const std::vector<std::size_t>& shape,
           const std::vector<float>& values);
  void add(const std::string& name, const std::vector<std::size_t>& shape,
           const std::vector<double>& values);
  void add(const std::string& name, const std::vector<std::size_t>& shape,
           const std::vector<std::uint8_t>& values);
  void add(const std::string& name, const std::vector<std::size_t>& shape,
           const std::vector<std::int32_t>& values);
  /// A matrix of one channel (CV_8U, CV_32S, CV_32F, CV_64F) as rows x cols.
  void add(const std::string& name, const cv::Mat& matrix);

  /// Writes the archive atomically; throws InputError if that fails.
  void write(const std::string& path) const;
  /// Archives that begin with this array.
  static FileKind kind(std::string name, const std::string& first_array);

 private:
  struct Member {
    std::string name;
    std::string bytes;  // the .npy file
  };

  void add_raw(const std::string& name, const std::vector<std::size_t>& shape, const char* type,
               std::size_t item_size, std::size_t count, const void* values);

  std::vector<Member> members_;
};

}  // namespace dxslam
