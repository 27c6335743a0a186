// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace dxslam {

/// Name and size of a matrix in a MATLAB file.
struct MatShape {
  std::string name;
  std::size_t rows = 0;
  std::size_t columns = 0;
};

/// Called for entries that are not zero, column by column, rows rising.
using MatEntryVisitor = std::function<void(std::size_t row, std::size_t column, double value)>;

/// Whether a file with this beginning is MATLAB's (versions 5 to 7, and 7.3, which read_mat
/// refuses).
bool begins_as_mat_file(std::string_view start);

/// Reads the largest real two-dimensional matrix of a MATLAB v5 file (MATLAB 5 to 7, Octave
/// `-mat`): dense or sparse, logical or of any number type, compressed or not, little-endian.
/// `begin` gets its shape before `entry` gets its entries. The matrix is never held as a whole, so
/// its size in memory is up to the caller. Throws InputError, one sentence with the file, for
/// another format, no matrix, a damaged file, or more than 2^31 entries.
MatShape read_mat(const std::string& path, const std::function<void(const MatShape&)>& begin,
                  const MatEntryVisitor& entry);

}  // namespace dxslam
