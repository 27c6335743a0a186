// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace dxslam {

// The frame of a map file (docs/file_formats.md): a header, sections one behind the other, and a
// table of the sections, each part with a checksum. Numbers are little-endian, as the machines are
// that the program is built for.

/// Puts sections into one string.
class SectionWriter {
 public:
  /// `expected_size` of the whole file, so that it is built in place.
  explicit SectionWriter(std::size_t expected_size);

  /// Ends the section before and starts one. `id` has four letters; programs that do not know a
  /// section skip it unless it is `required`.
  void begin(const char* id, std::uint32_t version, bool required);

  template <class Value>
  void put(const Value& value) {
    put_array(&value, 1);
  }
  template <class Value>
  void put_array(const Value* values, std::size_t count) {
    static_assert(std::is_trivially_copyable<Value>::value, "only plain values are written");
    if (count > 0) bytes_.append(reinterpret_cast<const char*>(values), count * sizeof(Value));
  }
  /// Length, then the bytes.
  void put_text(const std::string& text);
  /// Room for `size` bytes to be filled in by the caller before the next call.
  char* put_room(std::size_t size);

  /// The file.
  std::string finish();

 private:
  void end_section();
  std::string bytes_;
  std::string table_;
  bool open_ = false;
};

/// A section as it lies in the file.
struct Section {
  std::string id;
  std::uint32_t version = 0;
  bool required = false;
  std::string_view bytes;
};

/// Throws InputError unless `start`, the first kStartBytes of a file of `size` bytes, is the header
/// of a map file of this size: large files that are none need not be read.
inline constexpr std::size_t kStartBytes = 32;
void check_start(std::string_view start, std::size_t size, const std::string& where);

/// Whether a file that begins with these bytes, up to 8 of them, is a map file by its first
/// letters.
bool begins_like_a_map(std::string_view bytes);

/// Takes a file apart, checking sizes and checksums of all its parts. The sections point into
/// `file`. Throws InputError beginning with `where`.
std::vector<Section> read_sections(std::string_view file, const std::string& where);

/// Reads the content of a section; never beyond its end: then it throws InputError.
class SectionReader {
 public:
  SectionReader(const Section& section, std::string where)
      : bytes_(section.bytes), id_(section.id), where_(std::move(where)) {}

  template <class Value>
  Value get() {
    Value value{};
    get_array(&value, 1);
    return value;
  }
  template <class Value>
  void get_array(Value* values, std::size_t count) {
    static_assert(std::is_trivially_copyable<Value>::value, "only plain values are read");
    const std::string_view raw = take(count, sizeof(Value));
    if (!raw.empty()) std::memcpy(static_cast<void*>(values), raw.data(), raw.size());
  }
  std::string get_text();
  /// The next `count` records of `size` bytes each.
  std::string_view take(std::size_t count, std::size_t size);
  /// A count of records of at least `size` bytes each, which must still be there.
  std::size_t get_count(std::size_t size);
  std::size_t left() const { return bytes_.size(); }
  /// Throws unless all was read.
  void expect_end() const;
  /// Throws InputError: the file, that it is damaged, the section, and `what`.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::string_view bytes_;
  std::string id_;
  std::string where_;
};

}  // namespace dxslam
