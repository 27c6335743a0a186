// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/bags/compress.h"

#include <lz4frame.h>
#include <zstd.h>

#include "core/error.h"

namespace dxslam {

std::string compress(std::string_view bytes, const std::string& method) {
  if (method.empty()) return std::string(bytes);
  const bool zstd = method == "zstd";
  require(zstd || method == "lz4", "no way to compress of that name");
  std::string packed(
      zstd ? ZSTD_compressBound(bytes.size()) : LZ4F_compressFrameBound(bytes.size(), nullptr),
      '\0');
  const std::size_t size =
      zstd ? ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 1)
           : LZ4F_compressFrame(packed.data(), packed.size(), bytes.data(), bytes.size(), nullptr);
  const bool failed = zstd ? ZSTD_isError(size) != 0U : LZ4F_isError(size) != 0U;
  require(!failed, "compressing into a large enough buffer cannot fail");
  packed.resize(size);
  return packed;
}

}  // namespace dxslam
