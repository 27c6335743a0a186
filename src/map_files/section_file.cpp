// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map_files/section_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "io/primitives/lfs_pointer.h"
#include "io/primitives/text_file.h"
#include "map_files/crc32c.h"
#include "map_files/map_limits.h"

namespace dxslam {
namespace {

// What comes before the letters and after them shows damage by transfers that take it for text.
constexpr std::string_view kMagic(
    "\x89"
    "DXMAP\r\n",
    8);
constexpr std::uint32_t kFormat = 1;
constexpr std::size_t kIdSize = 4;
constexpr std::uint32_t kRequiredFlag = 1;

struct FileHeader {
  char magic[8];
  std::uint32_t format;
  std::uint32_t sections;
  std::uint64_t file_size;
  std::uint32_t table_checksum;
  std::uint32_t checksum;  // of all that is before it
};
static_assert(sizeof(FileHeader) == 32 && std::is_trivially_copyable_v<FileHeader>);

struct TableEntry {
  char id[kIdSize];
  std::uint32_t version;
  std::uint64_t offset;
  std::uint64_t size;
  std::uint32_t checksum;
  std::uint32_t flags;
};
static_assert(sizeof(TableEntry) == 32 && std::is_trivially_copyable_v<TableEntry>);

std::uint32_t checksum_of(const FileHeader& header) {
  return crc32c(&header, offsetof(FileHeader, checksum));
}

// The header of a file of `size` bytes that is whole by its own account.
FileHeader read_header(std::string_view file, std::size_t size, const std::string& where) {
  const std::string_view start = file.substr(0, kMagic.size());
  if (start != kMagic.substr(0, start.size()) || file.empty()) {
    throw InputError(
        fmt::format("{}: is no dxslam map, which would begin with DXMAP{}", where, lfs_hint(file)));
  }
  if (file.size() < sizeof(FileHeader)) {
    throw InputError(fmt::format("{}: map file is cut short after {} bytes", where, size));
  }
  FileHeader header;
  std::memcpy(&header, file.data(), sizeof header);
  if (header.checksum != checksum_of(header)) {
    throw InputError(
        fmt::format("{}: damaged map file: the header does not match its checksum", where));
  }
  if (header.format != kFormat) {
    throw InputError(fmt::format(
        "{}: map file of format {}, this program reads format {}; a newer dxslam wrote it", where,
        header.format, kFormat));
  }
  if (size < header.file_size) {
    throw InputError(fmt::format("{}: map file is cut short: it has {} of {} bytes", where, size,
                                 header.file_size));
  }
  if (size > header.file_size) {
    throw InputError(fmt::format("{}: damaged map file: it has {} bytes, expected {}", where, size,
                                 header.file_size));
  }
  return header;
}

}  // namespace

SectionWriter::SectionWriter(std::size_t expected_size) {
  bytes_.reserve(expected_size);
  bytes_.resize(sizeof(FileHeader));
}

void SectionWriter::begin(const char* id, std::uint32_t version, bool required) {
  require(std::strlen(id) == kIdSize, "the id of a section has four letters");
  end_section();
  TableEntry entry{};
  std::memcpy(entry.id, id, kIdSize);
  entry.version = version;
  entry.offset = bytes_.size();
  entry.flags = required ? kRequiredFlag : 0;
  table_.append(reinterpret_cast<const char*>(&entry), sizeof entry);
  open_ = true;
}

void SectionWriter::end_section() {
  if (!open_) return;
  char* const place = &table_[table_.size() - sizeof(TableEntry)];
  TableEntry entry;
  std::memcpy(&entry, place, sizeof entry);
  entry.size = bytes_.size() - entry.offset;
  entry.checksum = crc32c(&bytes_[entry.offset], entry.size);
  std::memcpy(place, &entry, sizeof entry);
  open_ = false;
}

void SectionWriter::put_text(const std::string& text) {
  require(is_possible_text(text), "a text that a map file cannot hold");
  put(static_cast<std::uint32_t>(text.size()));
  bytes_ += text;
}

char* SectionWriter::put_room(std::size_t size) {
  bytes_.resize(bytes_.size() + size);
  return bytes_.data() + bytes_.size() - size;
}

std::string SectionWriter::finish() {
  end_section();
  bytes_ += table_;
  FileHeader header{};
  std::memcpy(header.magic, kMagic.data(), kMagic.size());
  header.format = kFormat;
  header.sections = static_cast<std::uint32_t>(table_.size() / sizeof(TableEntry));
  header.file_size = bytes_.size();
  header.table_checksum = crc32c(table_.data(), table_.size());
  header.checksum = checksum_of(header);
  std::memcpy(bytes_.data(), &header, sizeof header);
  return std::move(bytes_);
}

void check_start(std::string_view start, std::size_t size, const std::string& where) {
  read_header(start, size, where);
}

bool begins_like_a_map(std::string_view bytes) { return bytes.substr(0, kMagic.size()) == kMagic; }

std::vector<Section> read_sections(std::string_view file, const std::string& where) {
  const FileHeader header = read_header(file, file.size(), where);
  const auto damaged = [&](const std::string& what) {
    return InputError(fmt::format("{}: damaged map file: {}", where, what));
  };
  const std::size_t content = file.size() - sizeof(FileHeader);
  if (header.sections > content / sizeof(TableEntry)) {
    throw damaged(fmt::format("{} sections in {} bytes", header.sections, file.size()));
  }
  const std::size_t table_begin = file.size() - header.sections * sizeof(TableEntry);
  const std::string_view table = file.substr(table_begin);
  if (crc32c(table.data(), table.size()) != header.table_checksum) {
    throw damaged("the table of sections does not match its checksum");
  }
  std::vector<Section> sections;
  for (std::size_t i = 0; i < header.sections; ++i) {
    TableEntry entry;
    std::memcpy(&entry, table.data() + i * sizeof entry, sizeof entry);
    Section section;
    section.id.assign(entry.id, kIdSize);
    if (entry.offset < sizeof(FileHeader) || entry.offset > table_begin ||
        entry.size > table_begin - entry.offset) {
      throw damaged(fmt::format("section {} lies outside the file", in_quotes(section.id)));
    }
    section.version = entry.version;
    section.required = (entry.flags & kRequiredFlag) != 0;
    section.bytes = file.substr(entry.offset, entry.size);
    if (crc32c(section.bytes.data(), section.bytes.size()) != entry.checksum) {
      throw damaged(fmt::format("section {} does not match its checksum", in_quotes(section.id)));
    }
    sections.push_back(std::move(section));
  }
  return sections;
}

std::string_view SectionReader::take(std::size_t count, std::size_t size) {
  if (size != 0 && count > bytes_.size() / size) fail("it ends before its content");
  const std::string_view taken = bytes_.substr(0, count * size);
  bytes_.remove_prefix(taken.size());
  return taken;
}

std::string SectionReader::get_text() {
  const auto size = get<std::uint32_t>();
  const std::string text(take(size, 1));
  if (!is_possible_text(text)) fail("a text that is too long or holds control characters");
  return text;
}

std::size_t SectionReader::get_count(std::size_t size) {
  const auto count = get<std::uint32_t>();
  if (count > bytes_.size() / size) fail(fmt::format("{} records do not fit into it", count));
  return count;
}

void SectionReader::expect_end() const {
  if (!bytes_.empty()) fail(fmt::format("{} bytes too many", bytes_.size()));
}

void SectionReader::fail(const std::string& what) const {
  throw InputError(fmt::format("{}: damaged map file: section {}: {}", where_, id_, what));
}

}  // namespace dxslam
