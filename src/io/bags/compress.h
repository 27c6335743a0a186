// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <string_view>

namespace dxslam {

/// What decompress() undoes: "" (as it is), "zstd" or "lz4" (a frame), each the quickest way.
/// Throws ContractError for other methods.
std::string compress(std::string_view bytes, const std::string& method);

}  // namespace dxslam
