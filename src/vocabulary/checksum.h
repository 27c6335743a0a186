// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <string_view>

namespace dxslam {

/// A sum over bytes that shows accidental damage (changed, missing and swapped parts), as quick as
/// memory is read. No protection against intent.
std::uint64_t fast_checksum(std::string_view bytes);

}  // namespace dxslam
