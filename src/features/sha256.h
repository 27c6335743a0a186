// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <string>

namespace dxslam {

/// SHA-256 (FIPS 180-4) in 64 lower-case hexadecimal digits.
std::string sha256(const void* data, std::size_t size);

/// The same of a file's content. Throws InputError if the file cannot be read.
std::string sha256_of_file(const std::string& path);

}  // namespace dxslam
