// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// MCAP, as ROS 2 and Foxglove write it: records of an operation code, a length and data. Messages
// lie in chunks with index records behind them, or by themselves. The summary at the end is read
// like the rest but not needed, so a file whose recorder was killed reads like any other.
#include <fmt/format.h>

#include <optional>
#include <unordered_map>
#include <unordered_set>

#include "core/error.h"
#include "io/bags/byte_reader.h"
#include "io/bags/decompress.h"
#include "io/bags/indexed_bag.h"
#include "io/bags/mcap_format.h"
#include "io/bags/random_access_file.h"
#include "io/primitives/crc32.h"
#include "io/primitives/limits.h"

namespace dxslam {
namespace {

constexpr std::uint64_t kHeadOfChunk = 8 + 8 + 8 + 4 + 4;  // up to its compression's text
constexpr std::size_t kHeadOfMessage = 2 + 4 + 8 + 8;      // channel, sequence, two times
using Op = McapOp;

struct Channel {
  std::uint16_t schema = 0;
  std::string topic;
  std::string encoding;
};

class Mcap : public IndexedBag {
 public:
  explicit Mcap(const std::string& path) : file_(path) {
    if (file_.size() < kMcapMagic.size() || file_.read(0, kMcapMagic.size()) != kMcapMagic) {
      throw InputError(fmt::format("{}: no MCAP file", path));
    }
    scan();
    finish_index(path);
  }

  std::string read(const BagEntry& entry) override {
    if (entry.chunk == 0) return message_at(entry.offset, limits::kBagChunkBytes);
    ByteReader reader(chunk_at(entry.chunk), file_.path());
    reader.take(entry.offset);
    if (static_cast<Op>(reader.number<std::uint8_t>()) != Op::kMessage) {
      throw InputError(file_.path() + ": damaged index, it points at no message");
    }
    return payload(reader.take(reader.number<std::uint64_t>()));
  }

  std::string read_start(const BagEntry& entry, std::size_t count) override {
    if (entry.chunk == 0) return message_at(entry.offset, count);
    const ChunkHead chunk = chunk_head(entry.chunk);
    return chunk.compression.empty() ? message_at(chunk.data + entry.offset, count) : read(entry);
  }

 private:
  struct Record {
    Op op = Op::kMessage;
    std::uint64_t data = 0;  // its first byte
    std::uint64_t length = 0;
    std::uint64_t end() const { return data + length; }
  };
  struct ChunkHead {
    std::string compression;
    std::uint64_t unpacked = 0;
    std::uint32_t checksum = 0;
    std::uint64_t data = 0;
    std::uint64_t packed = 0;
  };

  // Nothing where the file ends within the record.
  std::optional<Record> record_at(std::uint64_t at) const {
    if (at + 9 > file_.size()) return std::nullopt;
    const std::string head = file_.read(at, 9);
    ByteReader reader(head, file_.path());
    Record record;
    record.op = static_cast<Op>(reader.number<std::uint8_t>());
    record.data = at + 9;
    record.length = reader.number<std::uint64_t>();
    if (record.length > file_.size() - record.data) return std::nullopt;
    return record;
  }

  std::string small_record(const Record& record) const {
    if (record.length > limits::kBagRecordBytes) {
      throw InputError(fmt::format("{}: damaged, a record of {} bytes at byte {}", file_.path(),
                                   record.length, record.data));
    }
    return file_.read(record.data, record.length);
  }

  void scan() {
    const std::uint64_t end =
        file_.size() >= 2 * kMcapMagic.size() &&
                file_.read(file_.size() - kMcapMagic.size(), kMcapMagic.size()) == kMcapMagic
            ? file_.size() - kMcapMagic.size()
            : file_.size();
    scan_records(
        file_, kMcapMagic.size(), end, [this](std::uint64_t at) { return record_at(at); },
        [this](std::uint64_t at, const Record& record) { add_record(at, record); });
    add_messages_of_unindexed_chunk();
    name_topics();
  }

  void add_record(std::uint64_t at, const Record& record) {
    if (record.op == Op::kMessageIndex) {
      add_index(record, chunk_);
      indexed_ = true;
      return;
    }
    add_messages_of_unindexed_chunk();
    if (record.op == Op::kChunk) {
      chunk_ = at;
      indexed_ = false;
    }
    if (record.op == Op::kMessage) add_message(record);
    if (record.op == Op::kSchema) add_schema(small_record(record));
    if (record.op == Op::kChannel) add_channel(small_record(record));
  }

  // The last chunk of a file that was cut off has no index; some writers leave all out.
  void add_messages_of_unindexed_chunk() {
    if (indexed_) return;
    indexed_ = true;
    add_records_of(chunk_, true);
  }

  void add_index(const Record& record, std::uint64_t chunk) {
    const std::string bytes = small_record(record);
    ByteReader reader(bytes, file_.path());
    const auto channel = reader.number<std::uint16_t>();
    const std::string_view list = reader.string();
    ByteReader pairs(list, file_.path());
    while (!pairs.at_end()) {
      const auto time = static_cast<std::int64_t>(pairs.number<std::uint64_t>());
      add_entry({channel, time, 0, chunk, pairs.number<std::uint64_t>()});
    }
  }

  void add_message(const Record& record) {
    const std::string head =
        file_.read(record.data, std::min<std::uint64_t>(record.length, kHeadOfMessage));
    ByteReader reader(head, file_.path());
    const auto channel = reader.number<std::uint16_t>();
    reader.number<std::uint32_t>();  // sequence
    const auto time = static_cast<std::int64_t>(reader.number<std::uint64_t>());
    add_entry({channel, time, 0, 0, record.data - 9});
  }

  void add_schema(std::string_view bytes) {
    ByteReader reader(bytes, file_.path());
    const auto id = reader.number<std::uint16_t>();
    schemas_[id] = std::string(reader.string());
  }

  void add_channel(std::string_view bytes) {
    ByteReader reader(bytes, file_.path());
    const auto id = reader.number<std::uint16_t>();
    Channel channel;
    channel.schema = reader.number<std::uint16_t>();
    channel.topic = std::string(reader.string());
    channel.encoding = std::string(reader.string());
    channels_[id] = std::move(channel);
  }

  // Channels of a chunk and, if it has no index, its messages.
  void add_records_of(std::uint64_t position, bool messages) try {
    const std::string& chunk = chunk_at(position);
    ByteReader reader(chunk, file_.path());
    while (!reader.at_end()) {
      const std::uint64_t offset = reader.position();
      const auto op = static_cast<Op>(reader.number<std::uint8_t>());
      const std::string_view data = reader.take(reader.number<std::uint64_t>());
      if (op == Op::kSchema) add_schema(data);
      if (op == Op::kChannel) add_channel(data);
      if (op != Op::kMessage || !messages) continue;
      ByteReader message(data, file_.path());
      const auto channel = message.number<std::uint16_t>();
      message.number<std::uint32_t>();
      const auto time = static_cast<std::int64_t>(message.number<std::uint64_t>());
      add_entry({channel, time, 0, position, offset});
    }
  } catch (const InputError& e) {
    note(fmt::format("{}; what is whole in it is used", e.what()));
  }

  // Entries name channels so far. Those that no summary named are in the chunks.
  void name_topics() {
    std::unordered_set<std::uint64_t> learnt;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      const BagEntry& entry = entries_[i];
      if (channels_.count(static_cast<std::uint16_t>(entry.topic)) != 0 || entry.chunk == 0)
        continue;
      if (learnt.insert(entry.chunk).second) add_records_of(entry.chunk, false);
    }
    std::unordered_map<std::uint32_t, std::uint32_t> index_of;
    std::size_t kept = 0;
    for (BagEntry entry : entries_) {
      const auto found = channels_.find(static_cast<std::uint16_t>(entry.topic));
      if (found == channels_.end()) continue;
      const auto [it, is_new] =
          index_of.try_emplace(entry.topic, static_cast<std::uint32_t>(topics_.size()));
      if (is_new) topics_.push_back(topic_of(found->second));
      entry.topic = it->second;
      entries_[kept++] = entry;
    }
    entries_.resize(kept);
  }

  BagTopic topic_of(const Channel& channel) const {
    const auto schema = schemas_.find(channel.schema);
    return {channel.topic,
            schema == schemas_.end() ? channel.encoding : without_msg_folder(schema->second),
            channel.encoding == "ros1" ? MessageEncoding::kRos1 : MessageEncoding::kCdr, 0};
  }

  std::string message_at(std::uint64_t at, std::size_t count) const {
    const std::optional<Record> record = record_at(at);
    if (!record || record->op != Op::kMessage || record->length > limits::kBagChunkBytes) {
      throw InputError(file_.path() + ": damaged index, it points at no message");
    }
    return payload(
        file_.read(record->data, std::min<std::uint64_t>(record->length, kHeadOfMessage + count)));
  }

  std::string payload(std::string_view message) const {
    ByteReader reader(message, file_.path());
    reader.take(kHeadOfMessage);
    return std::string(reader.take(reader.left()));
  }

  ChunkHead chunk_head(std::uint64_t position) const {
    const std::optional<Record> record = record_at(position);
    if (!record || record->op != Op::kChunk) {
      throw InputError(file_.path() + ": damaged index, it points at no chunk");
    }
    const std::string head =
        file_.read(record->data, std::min<std::uint64_t>(record->length, kHeadOfChunk + 64 + 8));
    ByteReader reader(head, file_.path());
    ChunkHead chunk;
    reader.take(16);  // first and last time
    chunk.unpacked = reader.number<std::uint64_t>();
    chunk.checksum = reader.number<std::uint32_t>();
    chunk.compression = std::string(reader.string());
    chunk.packed = reader.number<std::uint64_t>();
    chunk.data = record->data + reader.position();
    if (chunk.packed > record->end() - chunk.data) {
      throw InputError(fmt::format("{}: damaged chunk at byte {}", file_.path(), position));
    }
    return chunk;
  }

  std::string unpack(std::uint64_t position) const override {
    const ChunkHead chunk = chunk_head(position);
    const std::string where = fmt::format("{}: chunk at byte {}", file_.path(), position);
    std::string bytes =
        decompress(file_.read(chunk.data, chunk.packed), chunk.compression, chunk.unpacked, where);
    if (chunk.checksum != 0 && crc32_of(bytes) != chunk.checksum) {
      throw InputError(where + " is damaged, its checksum is wrong");
    }
    return bytes;
  }

  RandomAccessFile file_;
  std::uint64_t chunk_ = 0;  // while scanning: the one that index records are of
  bool indexed_ = true;      // whether it has had some
  std::unordered_map<std::uint16_t, std::string> schemas_;  // names
  std::unordered_map<std::uint16_t, Channel> channels_;
};

}  // namespace

std::unique_ptr<BagFile> open_mcap(const std::string& file) { return std::make_unique<Mcap>(file); }

}  // namespace dxslam
