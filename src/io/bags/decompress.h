// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace dxslam {

/// Undoes "none" (or ""), "zstd", "lz4" (frames) or "bz2". `size` is what the file promises; the
/// result has exactly this size. Throws InputError, beginning with `where`, for other methods,
/// damaged data, another size, or one beyond limits::kBagChunkBytes.
std::string decompress(std::string_view packed, const std::string& method, std::uint64_t size,
                       const std::string& where);
/// The same for zstd that does not say how large it was, as ROS 2 compresses messages and files.
std::string decompress_zstd(std::string_view packed, const std::string& where);

}  // namespace dxslam
