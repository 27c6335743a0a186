// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/formats/npz_writer.h"

#include <fmt/format.h>

#include "core/error.h"
#include "io/primitives/atomic_file.h"
#include "io/primitives/crc32.h"

namespace dxslam {
namespace {

constexpr std::string_view kMemberMark = "PK\x03\x04";
constexpr std::size_t kMemberHeader = 30;  // bytes before the name of the first member
constexpr std::size_t kNpyAlignment = 64;
constexpr std::size_t kLargestArchive = 0xFFFFFFFFU;
constexpr std::uint32_t kDosEpoch = 0x00210000U;  // 1980-01-01 0:00: the same bytes every time

// Little-endian, as the zip format asks.
void append(std::string& bytes, std::uint32_t value, int width) {
  for (int i = 0; i < width; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFFU);
}

std::string npy_header(const std::vector<std::size_t>& shape, const char* type) {
  std::string sizes;
  for (const std::size_t size : shape) sizes += fmt::format("{},", size);
  std::string dictionary =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, sizes);
  std::string header("\x93NUMPY\x01\x00", 8);
  const std::size_t unpadded = header.size() + 2 + dictionary.size() + 1;
  dictionary.append((kNpyAlignment - unpadded % kNpyAlignment) % kNpyAlignment, ' ');
  dictionary += '\n';
  append(header, static_cast<std::uint32_t>(dictionary.size()), 2);
  return header + dictionary;
}

}  // namespace

void NpzWriter::add(const std::string& name, const std::vector<std::size_t>& shape,
                    const std::vector<float>& values) {
  add_raw(name, shape, "<f4", sizeof(float), values.size(), values.data());
}

void NpzWriter::add(const std::string& name, const std::vector<std::size_t>& shape,
                    const std::vector<double>& values) {
  add_raw(name, shape, "<f8", sizeof(double), values.size(), values.data());
}

void NpzWriter::add(const std::string& name, const std::vector<std::size_t>& shape,
                    const std::vector<std::uint8_t>& values) {
  add_raw(name, shape, "|u1", 1, values.size(), values.data());
}

void NpzWriter::add(const std::string& name, const std::vector<std::size_t>& shape,
                    const std::vector<std::int32_t>& values) {
  add_raw(name, shape, "<i4", sizeof(std::int32_t), values.size(), values.data());
}

void NpzWriter::add(const std::string& name, const cv::Mat& matrix) {
  require(matrix.channels() == 1 && matrix.dims <= 2, "only matrices of one channel are written");
  const cv::Mat packed = matrix.isContinuous() ? matrix : matrix.clone();
  const char* type = packed.depth() == CV_8U    ? "|u1"
                     : packed.depth() == CV_32S ? "<i4"
                     : packed.depth() == CV_32F ? "<f4"
                     : packed.depth() == CV_64F ? "<f8"
                                                : nullptr;
  require(type != nullptr, "element type not written to .npz");
  add_raw(name, {static_cast<std::size_t>(packed.rows), static_cast<std::size_t>(packed.cols)},
          type, packed.elemSize1(), packed.total(), packed.data);
}

void NpzWriter::add_raw(const std::string& name, const std::vector<std::size_t>& shape,
                        const char* type, std::size_t item_size, std::size_t count,
                        const void* values) {
  std::size_t expected = 1;
  for (const std::size_t size : shape) expected *= size;
  require(expected == count, "array " + name + " does not have the size of its shape");
  require(!name.empty() && name.find('/') == std::string::npos, "bad array name " + name);
  for (const Member& member : members_) {
    require(member.name != name + ".npy", "array " + name + " is there already");
  }
  std::string bytes = npy_header(shape, type);
  if (count > 0) bytes.append(static_cast<const char*>(values), count * item_size);
  members_.push_back({name + ".npy", std::move(bytes)});
}

FileKind NpzWriter::kind(std::string name, const std::string& first_array) {
  return {std::move(name), [member = first_array + ".npy"](std::string_view head) {
            return head.starts_with(kMemberMark) && head.size() > kMemberHeader &&
                   head.substr(kMemberHeader).starts_with(member);
          }};
}

void NpzWriter::write(const std::string& path) const {
  std::string archive;
  std::string directory;
  for (const Member& member : members_) {
    require(archive.size() + member.bytes.size() + directory.size() + 1024 < kLargestArchive,
            "archive beyond 4 GiB");
    const std::uint32_t checksum = crc32_of(member.bytes);
    const auto offset = static_cast<std::uint32_t>(archive.size());
    const auto size = static_cast<std::uint32_t>(member.bytes.size());
    // Version needed, flags, method (0: stored), time and date, checksum, sizes, name length.
    std::string fields;
    append(fields, 20, 2);
    append(fields, 0, 2);
    append(fields, 0, 2);
    append(fields, kDosEpoch, 4);
    append(fields, checksum, 4);
    append(fields, size, 4);
    append(fields, size, 4);
    append(fields, static_cast<std::uint32_t>(member.name.size()), 2);
    append(fields, 0, 2);  // extra field

    archive += kMemberMark;
    archive += fields + member.name + member.bytes;
    append(directory, 0x02014B50U, 4);
    append(directory, 20, 2);  // version made by
    directory += fields;
    directory.append(10, '\0');  // comment, disk, attributes
    append(directory, offset, 4);
    directory += member.name;
  }
  const auto directory_offset = static_cast<std::uint32_t>(archive.size());
  archive += directory;
  append(archive, 0x06054B50U, 4);
  append(archive, 0, 4);  // disks
  append(archive, static_cast<std::uint32_t>(members_.size()), 2);
  append(archive, static_cast<std::uint32_t>(members_.size()), 2);
  append(archive, static_cast<std::uint32_t>(directory.size()), 4);
  append(archive, directory_offset, 4);
  append(archive, 0, 2);  // comment
  write_file_atomically(path, archive);
}

}  // namespace dxslam
