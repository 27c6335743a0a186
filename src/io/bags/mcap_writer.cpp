// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/bags/mcap_writer.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "io/bags/byte_writer.h"
#include "io/bags/compress.h"
#include "io/bags/mcap_format.h"
#include "io/primitives/crc32.h"

namespace dxslam {
namespace {

using Op = McapOp;

std::string record(Op op, const ByteWriter& data) {
  return ByteWriter()
      .number(static_cast<std::uint8_t>(op))
      .number(static_cast<std::uint64_t>(data.bytes().size()))
      .raw(data.bytes())
      .bytes();
}

/// The summary as it grows, with where each kind of record begins.
class Summary {
 public:
  explicit Summary(std::uint64_t start) : start_(start) {}

  void add_group(Op op, const std::vector<std::string>& records) {
    const std::uint64_t begin = start_ + bytes_.size();
    for (const std::string& one : records) bytes_ += one;
    const std::uint64_t length = start_ + bytes_.size() - begin;
    if (length == 0) return;
    offsets_ +=
        record(Op::kSummaryOffset,
               ByteWriter().number(static_cast<std::uint8_t>(op)).number(begin).number(length));
  }
  /// With the footer.
  std::string finish() const {
    constexpr std::size_t kChecksumBytes = 4;
    const std::string footer =
        record(Op::kFooter,
               ByteWriter().number(start_).number(start_ + bytes_.size()).number(std::uint32_t{0}));
    std::string all = bytes_ + offsets_ + footer;
    all.resize(all.size() - kChecksumBytes);
    return ByteWriter().raw(all).number(crc32_of(all)).bytes();
  }

 private:
  std::uint64_t start_;
  std::string bytes_;
  std::string offsets_;
};

}  // namespace

McapWriter::McapWriter(const std::string& path, std::string compression)
    : file_(path), compression_(std::move(compression)) {
  append(std::string(kMcapMagic) +
         record(Op::kHeader, ByteWriter().string("ros2").string("dxslam")));
}

std::uint16_t McapWriter::add_topic(const std::string& topic, const std::string& type,
                                    const std::string& definition) {
  require(topics_.size() < UINT16_MAX, "too many topics");
  const auto id = static_cast<std::uint16_t>(topics_.size() + 1);  // no schema has number 0
  Topic made;
  made.schema = record(Op::kSchema,
                       ByteWriter().number(id).string(type).string("ros2msg").string(definition));
  made.channel = record(
      Op::kChannel,
      ByteWriter().number(id).number(id).string(topic).string("cdr").number(std::uint32_t{0}));
  topics_.push_back(std::move(made));
  return id;
}

void McapWriter::add(std::uint16_t topic, std::uint64_t time_ns, std::string_view message) {
  require(topic > 0 && topic <= topics_.size(), "no such topic");
  Topic& of = topics_[topic - 1U];
  // In the first chunk of its messages: a file that is cut off behind it can be read.
  if (of.messages == 0 && !std::exchange(of.in_chunk, true)) chunk_ += of.schema + of.channel;
  if (index_.empty()) chunk_times_ = {time_ns, time_ns};
  chunk_times_.first = std::min(chunk_times_.first, time_ns);
  chunk_times_.last = std::max(chunk_times_.last, time_ns);
  index_[topic].push_back({time_ns, chunk_.size()});
  const auto sequence = static_cast<std::uint32_t>(of.messages + index_[topic].size());
  chunk_ += record(
      Op::kMessage,
      ByteWriter().number(topic).number(sequence).number(time_ns).number(time_ns).raw(message));
}

void McapWriter::flush() {
  if (index_.empty()) return;
  const std::string packed = compress(chunk_, compression_);
  const ByteWriter times = ByteWriter().number(chunk_times_.first).number(chunk_times_.last);
  std::string bytes = record(Op::kChunk, ByteWriter()
                                             .raw(times.bytes())
                                             .number(static_cast<std::uint64_t>(chunk_.size()))
                                             .number(crc32_of(chunk_))
                                             .string(compression_)
                                             .number(static_cast<std::uint64_t>(packed.size()))
                                             .raw(packed));
  const std::uint64_t length = bytes.size();
  ByteWriter places;  // of the index records
  for (const auto& [topic, entries] : index_) {
    places.number(topic).number(file_.size() + bytes.size());
    bytes += index_record(topic, entries);
  }
  const std::string in_summary =
      record(Op::kChunkIndex, ByteWriter()
                                  .raw(times.bytes())
                                  .number(file_.size())
                                  .number(length)
                                  .string(places.bytes())
                                  .number(static_cast<std::uint64_t>(bytes.size()) - length)
                                  .string(compression_)
                                  .number(static_cast<std::uint64_t>(packed.size()))
                                  .number(static_cast<std::uint64_t>(chunk_.size())));
  const Index written = std::exchange(index_, {});
  chunk_.clear();
  for (Topic& topic : topics_) topic.in_chunk = false;
  append(bytes);
  if (chunk_indexes_.empty()) times_ = chunk_times_;
  times_.first = std::min(times_.first, chunk_times_.first);
  times_.last = std::max(times_.last, chunk_times_.last);
  chunk_indexes_.push_back(in_summary);
  for (const auto& [topic, entries] : written) topics_[topic - 1U].messages += entries.size();
}

std::string McapWriter::index_record(std::uint16_t topic, const std::vector<IndexEntry>& entries) {
  ByteWriter pairs;
  for (const IndexEntry& entry : entries) pairs.number(entry.time).number(entry.offset);
  return record(Op::kMessageIndex, ByteWriter().number(topic).string(pairs.bytes()));
}

void McapWriter::finish() {
  flush();
  append(record(Op::kDataEnd, ByteWriter().number(checksum_)));
  std::vector<std::string> schemas;
  std::vector<std::string> channels;
  for (const Topic& topic : topics_) {
    schemas.push_back(topic.schema);
    channels.push_back(topic.channel);
  }
  Summary summary(file_.size());
  summary.add_group(Op::kSchema, schemas);
  summary.add_group(Op::kChannel, channels);
  summary.add_group(Op::kStatistics, {statistics()});
  summary.add_group(Op::kChunkIndex, chunk_indexes_);
  append(summary.finish() + std::string(kMcapMagic));
}

std::string McapWriter::statistics() const {
  std::uint64_t messages = 0;
  ByteWriter counts;
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    messages += topics_[i].messages;
    counts.number(static_cast<std::uint16_t>(i + 1)).number(topics_[i].messages);
  }
  return record(Op::kStatistics, ByteWriter()
                                     .number(messages)
                                     .number(static_cast<std::uint16_t>(topics_.size()))
                                     .number(static_cast<std::uint32_t>(topics_.size()))
                                     .number(std::uint32_t{0})  // attachments
                                     .number(std::uint32_t{0})  // metadata
                                     .number(static_cast<std::uint32_t>(chunk_indexes_.size()))
                                     .number(times_.first)
                                     .number(times_.last)
                                     .string(counts.bytes()));
}

void McapWriter::append(const std::string& bytes) {
  file_.append(bytes);
  checksum_ = crc32_of(bytes, checksum_);
}

}  // namespace dxslam
