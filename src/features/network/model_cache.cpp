// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/network/model_cache.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <filesystem>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "core/error.h"
#include "io/primitives/atomic_file.h"
#include "io/primitives/text_file.h"

namespace dxslam {
namespace {

constexpr std::string_view kMagic = "DXNETC01";
constexpr std::size_t kMostBytes = std::size_t{4} << 30;

struct Header {
  char magic[8];
  std::uint64_t size;  // of the content
  std::uint64_t checksum[2];
};
static_assert(sizeof(Header) == 32);

// Of the key, too: a file that was renamed is no other network's.
Header header_of(const std::string& key, std::string_view content) {
  Header header{};
  std::memcpy(header.magic, kMagic.data(), kMagic.size());
  header.size = content.size();
  const XXH64_hash_t seed = XXH3_64bits(key.data(), key.size());
  const XXH128_hash_t sum = XXH3_128bits_withSeed(content.data(), content.size(), seed);
  header.checksum[0] = sum.low64;
  header.checksum[1] = sum.high64;
  return header;
}

}  // namespace

ModelCache::ModelCache(const std::string& folder) : folder_(folder) {
  if (folder_.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (!error && ::access(folder_.c_str(), W_OK | X_OK) != 0) {
    error = std::error_code(errno, std::generic_category());
  }
  if (!error) return;
  note_ = fmt::format("compiled networks are not kept, every start takes longer: {}: {}", folder_,
                      error.message());
}

std::string ModelCache::path_of(const std::string& key) const {
  const XXH128_hash_t name = XXH3_128bits(key.data(), key.size());
  return fmt::format("{}/{:016x}{:016x}.network", folder_, name.high64, name.low64);
}

std::optional<std::string> ModelCache::load(const std::string& key) const {
  if (!usable()) return std::nullopt;
  const std::string path = path_of(key);
  std::error_code error;
  if (!std::filesystem::exists(path, error) && !error) return std::nullopt;
  try {
    std::string content = read_file(path, "a compiled network", kMostBytes);
    Header found{};
    if (content.size() >= sizeof found) {
      std::memcpy(&found, content.data(), sizeof found);
      content.erase(0, sizeof found);
      const Header expected = header_of(key, content);
      if (std::memcmp(&found, &expected, sizeof found) == 0) return content;
    }
  } catch (const std::exception&) {  // a pipe, say, which nobody must wait for
  }
  remove(key);
  return std::nullopt;
}

void ModelCache::store(const std::string& key, std::string_view content) const {
  if (!usable()) return;
  const Header header = header_of(key, content);
  std::string bytes(reinterpret_cast<const char*>(&header), sizeof header);
  bytes += content;
  try {
    const std::string path = path_of(key);
    remove_stale_temporaries(path);
    write_file_atomically(path, bytes);
  } catch (const InputError&) {  // a full disk
  }
}

void ModelCache::remove(const std::string& key) const {
  std::error_code ignored;
  std::filesystem::remove(path_of(key), ignored);
}

}  // namespace dxslam
