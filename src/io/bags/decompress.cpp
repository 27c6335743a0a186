// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/bags/decompress.h"

#include <bzlib.h>
#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include <memory>

#include "core/error.h"
#include "io/primitives/limits.h"
#include "io/primitives/text_file.h"

namespace dxslam {
namespace {

constexpr std::size_t kFirstGuess = 1U << 20U;

[[noreturn]] void damaged(const std::string& where, const char* method, const char* why) {
  throw InputError(fmt::format("{}: damaged {} data: {}", where, method, why));
}

void check_size(std::uint64_t size, const std::string& where) {
  if (size <= limits::kBagChunkBytes) return;
  throw InputError(fmt::format("{}: {} bytes when unpacked, expected at most {}", where, size,
                               limits::kBagChunkBytes));
}

// So that no memory is asked for by a few bytes that can never fill it.
void check_ratio(std::size_t packed, std::uint64_t size, const char* method, std::uint64_t most,
                 const std::string& where) {
  if (size / most > packed) damaged(where, method, "far fewer bytes than the file says");
}

void unpack_zstd(std::string_view packed, std::string& out, const std::string& where) {
  const std::size_t n = ZSTD_decompress(out.data(), out.size(), packed.data(), packed.size());
  if (ZSTD_isError(n) != 0U) damaged(where, "zstd", ZSTD_getErrorName(n));
  if (n != out.size()) damaged(where, "zstd", "shorter than the file says");
}

void unpack_lz4(std::string_view packed, std::string& out, const std::string& where) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0U) {
    throw InputError(where + ": no memory to unpack lz4 data");
  }
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      made, LZ4F_freeDecompressionContext);
  std::size_t in = 0;
  std::size_t done = 0;
  std::size_t hint = 1;
  while (hint != 0) {
    std::size_t room = out.size() - done;
    std::size_t taken = packed.size() - in;
    hint = LZ4F_decompress(context.get(), out.data() + done, &room, packed.data() + in, &taken,
                           nullptr);
    if (LZ4F_isError(hint) != 0U) damaged(where, "lz4", LZ4F_getErrorName(hint));
    if (room == 0 && taken == 0) break;
    done += room;
    in += taken;
  }
  if (hint != 0 || done != out.size()) damaged(where, "lz4", "another size than the file says");
}

void unpack_bz2(std::string_view packed, std::string& out, const std::string& where) {
  auto size = static_cast<unsigned>(out.size());
  const int result = BZ2_bzBuffToBuffDecompress(out.data(), &size, const_cast<char*>(packed.data()),
                                                static_cast<unsigned>(packed.size()), 0, 0);
  if (result != BZ_OK) damaged(where, "bz2", "it does not unpack");
  if (size != out.size()) damaged(where, "bz2", "shorter than the file says");
}

}  // namespace

std::string decompress(std::string_view packed, const std::string& method, std::uint64_t size,
                       const std::string& where) {
  check_size(size, where);
  if (method.empty() || method == "none") {
    if (packed.size() != size) damaged(where, "plain", "another size than the file says");
    return std::string(packed);
  }
  constexpr std::uint64_t kMostOfLz4 = 255;         // bytes out of one
  constexpr std::uint64_t kMostOfRuns = 1U << 16U;  // of zstd and bz2
  check_ratio(packed.size(), size, method.c_str(), method == "lz4" ? kMostOfLz4 : kMostOfRuns,
              where);
  std::string out(size, '\0');
  if (method == "zstd") {
    unpack_zstd(packed, out, where);
  } else if (method == "lz4") {
    unpack_lz4(packed, out, where);
  } else if (method == "bz2") {
    unpack_bz2(packed, out, where);
  } else {
    throw InputError(fmt::format("{}: compressed by {}, expected none, zstd, lz4 or bz2", where,
                                 in_quotes(method)));
  }
  return out;
}

std::string decompress_zstd(std::string_view packed, const std::string& where) {
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(),
                                                                     ZSTD_freeDCtx);
  std::string out(kFirstGuess, '\0');
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  std::size_t done = 0;
  std::size_t hint = 1;
  while (hint != 0) {
    if (done == out.size()) {
      check_size(2 * std::uint64_t{out.size()}, where);
      out.resize(2 * out.size());
    }
    ZSTD_outBuffer buffer{out.data(), out.size(), done};
    hint = ZSTD_decompressStream(context.get(), &buffer, &in);
    if (ZSTD_isError(hint) != 0U) damaged(where, "zstd", ZSTD_getErrorName(hint));
    if (buffer.pos == done && in.pos == in.size && hint != 0)
      damaged(where, "zstd", "it is cut off");
    done = buffer.pos;
  }
  out.resize(done);
  return out;
}

}  // namespace dxslam
