// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "vocabulary/training_checkpoint.h"

#include <fmt/format.h>

#include <cstring>
#include <string_view>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "core/error.h"
#include "vocabulary/mapped_file.h"

namespace dxslam {
namespace {

constexpr std::string_view kSignature = "dxslam vocabulary training 2\n";
constexpr std::size_t kChecksumBytes = 8;

class Writer {
 public:
  void number(std::uint64_t value) { raw(&value, sizeof(value)); }
  void text(std::string_view value) {
    number(value.size());
    raw(value.data(), value.size());
  }
  template <class Value>
  void list(const std::vector<Value>& values) {
    number(values.size());
    raw(values.data(), values.size() * sizeof(Value));
  }
  void matrix(const cv::Mat& rows) {
    number(static_cast<std::uint64_t>(rows.rows));
    for (int i = 0; i < rows.rows; ++i) raw(rows.ptr(i), rows.elemSize() * rows.cols);
  }
  void raw(const void* data, std::size_t size) {
    if (size > 0) bytes.append(static_cast<const char*>(data), size);
  }

  std::string bytes;
};

class Reader {
 public:
  Reader(std::string_view rest, const std::string& path) : rest_(rest), path_(path) {}

  std::uint64_t number() {
    std::uint64_t value = 0;
    raw(&value, sizeof(value));
    return value;
  }
  std::string text() {
    std::string value(count(1), '\0');
    raw(value.data(), value.size());
    return value;
  }
  template <class Value>
  void list(std::vector<Value>& values) {
    values.resize(count(sizeof(Value)));
    raw(values.data(), values.size() * sizeof(Value));
  }
  cv::Mat matrix(int type, int dimension) {
    const std::size_t row = CV_ELEM_SIZE(type) * static_cast<std::size_t>(dimension);
    const std::size_t rows = count(row);
    if (rows > 100'000'000) fail();
    cv::Mat matrix(static_cast<int>(rows), dimension, type);
    if (rows > 0) raw(matrix.data, rows * row);
    return matrix;
  }
  void end() const {
    if (!rest_.empty()) fail();
  }
  /// A number of things of `size` bytes each, which the rest of the file has room for.
  std::size_t count(std::size_t size) {
    const std::uint64_t n = number();
    if (n > rest_.size() / size) fail();
    return static_cast<std::size_t>(n);
  }

 private:
  [[noreturn]] void fail() const {
    throw InputError(
        fmt::format("{}: is no whole checkpoint of a training with these descriptors", path_));
  }
  void raw(void* data, std::size_t size) {
    if (size > rest_.size()) fail();
    if (size > 0) std::memcpy(data, rest_.data(), size);
    rest_.remove_prefix(size);
  }

  std::string_view rest_;
  std::string path_;
};

}  // namespace

std::string format_checkpoint(const TrainingCheckpoint& state) {
  Writer writer;
  writer.raw(kSignature.data(), kSignature.size());
  writer.text(state.source);
  writer.number(state.position);
  writer.number(state.images);
  writer.list(state.sums);
  writer.list(state.totals);
  writer.list(state.last_words);
  writer.matrix(state.last_descriptors);
  writer.number(state.sample_stride);
  writer.number(state.sample_offered);
  writer.number(state.sample.size());
  for (const cv::Mat& image : state.sample) writer.matrix(image);
  writer.number(XXH3_64bits(writer.bytes.data(), writer.bytes.size()));
  return std::move(writer.bytes);
}

TrainingCheckpoint read_checkpoint(const std::string& path, int type, int dimension) {
  const MappedFile file(path, "a checkpoint of a vocabulary training");
  std::string_view bytes(reinterpret_cast<const char*>(file.data()), file.size());
  if (bytes.substr(0, kSignature.size()) != kSignature ||
      bytes.size() < kSignature.size() + kChecksumBytes) {
    throw InputError(fmt::format("{}: is no checkpoint of a vocabulary training", path));
  }
  const std::string_view content = bytes.substr(0, bytes.size() - kChecksumBytes);
  std::uint64_t sum = 0;
  std::memcpy(&sum, bytes.data() + content.size(), kChecksumBytes);
  if (sum != XXH3_64bits(content.data(), content.size())) {
    throw InputError(fmt::format("{}: does not have the checksum it was written with", path));
  }
  Reader reader(content.substr(kSignature.size()), path);
  TrainingCheckpoint state;
  state.source = reader.text();
  state.position = reader.number();
  state.images = reader.number();
  reader.list(state.sums);
  reader.list(state.totals);
  reader.list(state.last_words);
  state.last_descriptors = reader.matrix(type, dimension);
  state.sample_stride = reader.number();
  state.sample_offered = reader.number();
  const std::size_t images = reader.count(sizeof(std::uint64_t));
  for (std::size_t i = 0; i < images; ++i) state.sample.push_back(reader.matrix(type, dimension));
  reader.end();
  if (state.sample_stride == 0) throw InputError(fmt::format("{}: is damaged", path));
  return state;
}

}  // namespace dxslam
