// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/mat_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "io/primitives/text_file.h"

namespace dxslam {
namespace {

constexpr std::size_t kHeaderSize = 128;
constexpr std::uint64_t kMostEntries = std::uint64_t{1} << 31;
constexpr std::uint32_t kMostStored = 1U << 26;  // entries of a sparse matrix: 256 MB
constexpr std::size_t kChunk = 1 << 16;

// Types of data elements ("mi") and classes of arrays ("mx") of the format.
enum MiType : std::uint32_t {
  kInt8 = 1,
  kUint8 = 2,
  kInt16 = 3,
  kUint16 = 4,
  kInt32 = 5,
  kUint32 = 6,
  kSingle = 7,
  kDouble = 9,
  kInt64 = 12,
  kUint64 = 13,
  kMatrix = 14,
  kCompressed = 15
};
constexpr std::uint32_t kSparseClass = 5;
constexpr std::uint32_t kFirstNumericClass = 6;
constexpr std::uint32_t kLastNumericClass = 15;
constexpr std::uint32_t kComplexFlag = 0x800;

std::size_t size_of(std::uint32_t type) {
  switch (type) {
    case kInt8:
    case kUint8:
      return 1;
    case kInt16:
    case kUint16:
      return 2;
    case kInt32:
    case kUint32:
    case kSingle:
      return 4;
    case kDouble:
    case kInt64:
    case kUint64:
      return 8;
    default:
      return 0;
  }
}

template <class Number>
double load_as(const char* bytes) {
  Number value;
  std::memcpy(&value, bytes, sizeof(value));
  return static_cast<double>(value);
}

double load(std::uint32_t type, const char* bytes) {
  switch (type) {
    case kInt8:
      return load_as<std::int8_t>(bytes);
    case kUint8:
      return load_as<std::uint8_t>(bytes);
    case kInt16:
      return load_as<std::int16_t>(bytes);
    case kUint16:
      return load_as<std::uint16_t>(bytes);
    case kInt32:
      return load_as<std::int32_t>(bytes);
    case kUint32:
      return load_as<std::uint32_t>(bytes);
    case kSingle:
      return load_as<float>(bytes);
    case kInt64:
      return load_as<std::int64_t>(bytes);
    case kUint64:
      return load_as<std::uint64_t>(bytes);
    default:
      return load_as<double>(bytes);
  }
}

/// Bytes of one top-level element, inflated on the way where they are compressed.
class ElementBytes {
 public:
  ElementBytes(std::string_view bytes, bool compressed, const std::string& path)
      : bytes_(bytes), compressed_(compressed), path_(path) {
    if (!compressed_) return;
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes_.data()));
    stream_.avail_in = static_cast<uInt>(bytes_.size());
    require(inflateInit(&stream_) == Z_OK, "zlib does not start");
  }
  ~ElementBytes() {
    if (compressed_) inflateEnd(&stream_);
  }
  ElementBytes(const ElementBytes&) = delete;
  ElementBytes& operator=(const ElementBytes&) = delete;

  void read(char* to, std::size_t size) {
    if (!compressed_) {
      if (size > bytes_.size()) fail("cut short");
      std::memcpy(to, bytes_.data(), size);
      bytes_.remove_prefix(size);
      return;
    }
    stream_.next_out = reinterpret_cast<Bytef*>(to);
    stream_.avail_out = static_cast<uInt>(size);
    while (stream_.avail_out > 0) {
      const int status = inflate(&stream_, Z_NO_FLUSH);
      if (status == Z_STREAM_END && stream_.avail_out > 0) fail("cut short");
      if (status != Z_OK && status != Z_STREAM_END) fail("damaged");
    }
  }

  void skip(std::uint64_t size) {
    std::array<char, 4096> rest;
    while (size > 0) {
      const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(size, rest.size()));
      read(rest.data(), part);
      size -= part;
    }
  }

  /// No more bytes than these can still be read: what is there, inflated as far as deflate can.
  std::uint64_t most_left() const {
    constexpr std::uint64_t kMostInflation = 1032;
    constexpr std::uint64_t kMostPending = std::uint64_t{1} << 16;
    return compressed_ ? kMostInflation * stream_.avail_in + kMostPending : bytes_.size();
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(
        fmt::format("{}: matrix data are {}, expected a whole MATLAB v5 file", path_, what));
  }

 private:
  std::string_view bytes_;
  bool compressed_;
  const std::string& path_;
  z_stream stream_{};
};

struct Tag {
  std::uint32_t type = 0;
  std::uint32_t size = 0;
  bool small = false;            // the data lie in the tag itself
  std::array<char, 4> inside{};  // those

  std::uint32_t padding() const { return small ? 0 : (8 - size % 8) % 8; }
};

Tag read_tag(ElementBytes& bytes) {
  std::array<char, 8> raw;
  bytes.read(raw.data(), raw.size());
  Tag tag;
  std::memcpy(&tag.type, raw.data(), 4);
  std::memcpy(&tag.size, raw.data() + 4, 4);
  if (tag.type >> 16U != 0) {
    tag.small = true;
    tag.size = tag.type >> 16U;
    tag.type &= 0xFFFFU;
    if (tag.size > 4) bytes.fail("damaged");
    std::memcpy(tag.inside.data(), raw.data() + 4, 4);
  }
  return tag;
}

/// A short element (flags, sizes, name) as a whole.
std::string read_short(ElementBytes& bytes, std::uint32_t* type = nullptr) {
  constexpr std::uint32_t kLongest = 4096;
  const Tag tag = read_tag(bytes);
  if (type != nullptr) *type = tag.type;
  if (tag.size > kLongest) bytes.fail("damaged");
  if (tag.small) return {tag.inside.data(), tag.size};
  std::string data(tag.size, '\0');
  bytes.read(data.data(), data.size());
  bytes.skip(tag.padding());
  return data;
}

/// Values of one numeric element, in order.
template <class Visitor>
void for_each_value(ElementBytes& bytes, std::uint64_t expected, const Visitor& visit) {
  const Tag tag = read_tag(bytes);
  const std::size_t width = size_of(tag.type);
  if (width == 0 || tag.size != expected * width) bytes.fail("damaged");
  std::vector<char> chunk(kChunk);
  std::uint64_t index = 0;
  for (std::uint64_t left = tag.size; left > 0;) {
    const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(left, chunk.size()));
    if (tag.small) {
      std::memcpy(chunk.data(), tag.inside.data(), part);
    } else {
      bytes.read(chunk.data(), part);
    }
    for (std::size_t i = 0; i < part; i += width, ++index) {
      if (width == 1 && chunk[i] == 0) continue;
      visit(index, load(tag.type, chunk.data() + i));
    }
    left -= part;
  }
  bytes.skip(tag.padding());
}

struct ArrayHeader {
  std::uint32_t array_class = 0;
  std::uint32_t stored = 0;  // places for entries, of a sparse matrix
  MatShape shape;
};

/// Header of a real two-dimensional array of numbers; nothing for other arrays.
std::optional<ArrayHeader> read_array_header(ElementBytes& bytes) {
  const std::string flags = read_short(bytes);
  if (flags.size() != 8) bytes.fail("damaged");
  std::uint32_t words[2];
  std::memcpy(words, flags.data(), 8);
  ArrayHeader header;
  header.array_class = words[0] & 0xFFU;
  header.stored = words[1];
  const bool numeric =
      header.array_class == kSparseClass ||
      (header.array_class >= kFirstNumericClass && header.array_class <= kLastNumericClass);
  if (!numeric || (words[0] & kComplexFlag) != 0) return std::nullopt;
  const std::string sizes = read_short(bytes);
  if (sizes.size() != 8) return std::nullopt;
  std::int32_t dimensions[2];
  std::memcpy(dimensions, sizes.data(), 8);
  if (dimensions[0] < 0 || dimensions[1] < 0) bytes.fail("damaged");
  header.shape.rows = static_cast<std::size_t>(dimensions[0]);
  header.shape.columns = static_cast<std::size_t>(dimensions[1]);
  header.shape.name = read_short(bytes);
  return header;
}

void read_dense(ElementBytes& bytes, const MatShape& shape, const MatEntryVisitor& entry) {
  for_each_value(bytes, std::uint64_t{shape.rows} * shape.columns,
                 [&](std::uint64_t index, double value) {
                   if (value != 0.0) entry(index % shape.rows, index / shape.rows, value);
                 });
}

void read_sparse(ElementBytes& bytes, const ArrayHeader& header, const MatEntryVisitor& entry) {
  const std::size_t columns = header.shape.columns;
  if (header.stored > kMostStored) bytes.fail("too many");
  if (header.stored + std::uint64_t{columns} > bytes.most_left()) bytes.fail("cut short");
  std::vector<std::uint32_t> rows(header.stored);
  std::vector<std::uint32_t> starts(columns + 1);
  for_each_value(bytes, rows.size(), [&](std::uint64_t i, double value) {
    rows[i] = static_cast<std::uint32_t>(std::clamp(value, 0.0, 4294967295.0));
  });
  for_each_value(bytes, starts.size(), [&](std::uint64_t i, double value) {
    starts[i] = static_cast<std::uint32_t>(std::clamp(value, 0.0, 4294967295.0));
  });
  const std::size_t used = starts.back();
  if (used > rows.size() || !std::is_sorted(starts.begin(), starts.end())) bytes.fail("damaged");
  const Tag tag = read_tag(bytes);
  const std::size_t width = size_of(tag.type);
  if (width == 0 || tag.size / width < used) bytes.fail("damaged");
  std::size_t column = 0;
  for (std::size_t i = 0; i < used; ++i) {
    while (starts[column + 1] <= i) ++column;
    std::array<char, 8> raw;
    if (tag.small) {
      std::memcpy(raw.data(), tag.inside.data() + i * width, width);
    } else {
      bytes.read(raw.data(), width);
    }
    if (rows[i] >= header.shape.rows) bytes.fail("damaged");
    const double value = load(tag.type, raw.data());
    if (value != 0.0) entry(rows[i], column, value);
  }
}

class MatFile {
 public:
  explicit MatFile(const std::string& path)
      : path_(path), bytes_(read_file(path, "a MATLAB v5 file")) {
    const std::string_view text = std::string_view(bytes_).substr(0, 20);
    if (text.substr(0, 10) == "MATLAB 7.3") {
      throw InputError(fmt::format(
          "{}: a MATLAB 7.3 (HDF5) file, expected version 5 to 7 (save it with '-v7')", path));
    }
    if (bytes_.size() < kHeaderSize || text.substr(0, 7) != "MATLAB ") {
      throw InputError(fmt::format("{}: no MATLAB file header, expected a MATLAB v5 file", path));
    }
    if (std::string_view(bytes_).substr(124, 4) != std::string_view("\x00\x01IM", 4)) {
      throw InputError(fmt::format(
          "{}: big-endian or of an unknown version, expected a little-endian MATLAB v5 file",
          path));
    }
  }

  /// Calls visit(element bytes, header) for each real matrix.
  template <class Visitor>
  void for_each_matrix(const Visitor& visit) const {
    std::string_view rest = std::string_view(bytes_).substr(kHeaderSize);
    while (rest.size() >= 8) {
      std::uint32_t words[2];
      std::memcpy(words, rest.data(), 8);
      rest.remove_prefix(8);
      if (words[1] > rest.size()) {
        throw InputError(
            fmt::format("{}: cut short, expected a whole MATLAB v5 file of {} more bytes", path_,
                        words[1] - rest.size()));
      }
      visit_element(words[0], rest.substr(0, words[1]), visit);
      // Compressed elements, unlike all others, are not padded.
      const std::size_t padding = words[0] == kCompressed ? 0 : (8 - words[1] % 8) % 8;
      rest.remove_prefix(std::min<std::size_t>(rest.size(), words[1] + padding));
    }
  }

 private:
  template <class Visitor>
  void visit_element(std::uint32_t type, std::string_view data, const Visitor& visit) const {
    if (type != kMatrix && type != kCompressed) return;
    ElementBytes bytes(data, type == kCompressed, path_);
    if (type == kCompressed && read_tag(bytes).type != kMatrix) return;
    if (type == kMatrix && data.empty()) return;
    const std::optional<ArrayHeader> header = read_array_header(bytes);
    if (header) visit(bytes, *header);
  }

  const std::string& path_;
  std::string bytes_;
};

std::uint64_t entries(const MatShape& shape) { return std::uint64_t{shape.rows} * shape.columns; }

}  // namespace

bool begins_as_mat_file(std::string_view start) { return start.substr(0, 7) == "MATLAB "; }

MatShape read_mat(const std::string& path, const std::function<void(const MatShape&)>& begin,
                  const MatEntryVisitor& entry) {
  const MatFile file(path);
  MatShape largest;
  file.for_each_matrix([&](ElementBytes&, const ArrayHeader& header) {
    if (entries(header.shape) > entries(largest)) largest = header.shape;
  });
  if (entries(largest) == 0) {
    throw InputError(fmt::format("{}: no real matrix in it, expected one", path));
  }
  if (entries(largest) > kMostEntries) {
    throw InputError(fmt::format("{}: matrix {} of {} x {} entries, expected at most {}", path,
                                 in_quotes(largest.name), largest.rows, largest.columns,
                                 kMostEntries));
  }
  bool done = false;
  file.for_each_matrix([&](ElementBytes& bytes, const ArrayHeader& header) {
    if (done || entries(header.shape) != entries(largest)) return;
    done = true;
    begin(header.shape);
    if (header.array_class == kSparseClass) {
      read_sparse(bytes, header, entry);
    } else {
      read_dense(bytes, header.shape, entry);
    }
  });
  return largest;
}

}  // namespace dxslam
