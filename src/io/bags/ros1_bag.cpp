// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// ROS 1 bags of version 2.0: records of a header (fields "name=value") and data. Messages lie in
// chunks; records behind each chunk say where in it. The table at the end of the file is not
// needed, so a bag whose recorder was killed reads like any other.
#include <fmt/format.h>

#include <map>
#include <optional>
#include <unordered_map>
#include <unordered_set>

#include "core/error.h"
#include "io/bags/byte_reader.h"
#include "io/bags/decompress.h"
#include "io/bags/indexed_bag.h"
#include "io/bags/random_access_file.h"

namespace dxslam {
namespace {

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
constexpr std::uint32_t kLargestHeader = 1U << 20U;
constexpr std::size_t kHeadOfMessage = 256;  // bytes; usual are 50
constexpr const char* kDamagedIndex = ": damaged index, it points at no message";
enum class Op : std::uint8_t {
  kMessage = 2,
  kBagHeader = 3,
  kIndex = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7
};

/// The fields of a record's header.
class Fields {
 public:
  Fields(std::string_view bytes, const std::string& where) : where_(where) {
    ByteReader reader(bytes, where);
    while (!reader.at_end()) {
      const std::string_view field = reader.string();
      const std::size_t equals = field.find('=');
      if (equals == std::string_view::npos) {
        throw InputError(where + ": damaged record, a field of its header has no name");
      }
      values_[std::string(field.substr(0, equals))] = field.substr(equals + 1);
    }
  }
  std::string_view text(const std::string& name) const {
    const auto found = values_.find(name);
    if (found == values_.end()) {
      throw InputError(fmt::format("{}: damaged record without the field `{}`", where_, name));
    }
    return found->second;
  }
  template <class Number>
  Number number(const std::string& name) const {
    return ByteReader(text(name), where_).number<Number>();
  }
  Op op() const { return static_cast<Op>(number<std::uint8_t>("op")); }

 private:
  std::string where_;
  std::map<std::string, std::string_view> values_;
};

std::int64_t nanoseconds(ByteReader& reader) {
  const auto seconds = reader.number<std::uint32_t>();
  return std::int64_t{seconds} * 1'000'000'000 + reader.number<std::uint32_t>();
}

class Ros1Bag : public IndexedBag {
 public:
  explicit Ros1Bag(const std::string& path) : file_(path) {
    if (file_.size() < kMagic.size() || file_.read(0, kMagic.size()) != kMagic) {
      throw InputError(fmt::format("{}: no ROS 1 bag of version 2.0", path));
    }
    scan();
    finish_index(path);
  }

  std::string read(const BagEntry& entry) override {
    ByteReader reader(chunk_at(entry.chunk), file_.path());
    reader.take(entry.offset);
    pass_message_header(reader);
    return std::string(reader.string());
  }

  std::string read_start(const BagEntry& entry, std::size_t count) override {
    const Record chunk = chunk_record(entry.chunk);
    if (Fields(chunk.header, file_.path()).text("compression") != "none") return read(entry);
    const std::uint64_t begin = chunk.data + entry.offset;
    if (begin > chunk.end()) throw InputError(file_.path() + kDamagedIndex);
    const std::string bytes =
        file_.read(begin, std::min<std::uint64_t>(count + kHeadOfMessage, chunk.end() - begin));
    ByteReader reader(bytes, file_.path());
    pass_message_header(reader);
    const auto length = reader.number<std::uint32_t>();
    return std::string(reader.take(std::min<std::size_t>(length, reader.left())));
  }

 private:
  void pass_message_header(ByteReader& reader) const {
    const Fields fields(reader.string(), file_.path());
    if (fields.op() != Op::kMessage) throw InputError(file_.path() + kDamagedIndex);
  }

  struct Record {
    std::string header;
    std::uint64_t data = 0;  // its first byte
    std::uint32_t length = 0;
    std::uint64_t end() const { return data + length; }
  };

  // Nothing where the file ends within the record.
  std::optional<Record> record_at(std::uint64_t at) const {
    const auto length_at = [&](std::uint64_t position) -> std::optional<std::uint32_t> {
      if (position + 4 > file_.size()) return std::nullopt;
      return ByteReader(file_.read(position, 4), file_.path()).number<std::uint32_t>();
    };
    const auto header = length_at(at);
    if (!header) return std::nullopt;
    if (*header > kLargestHeader) {
      throw InputError(fmt::format("{}: damaged at byte {}, a record header of {} bytes",
                                   file_.path(), at, *header));
    }
    const auto length = length_at(at + 4 + *header);
    if (!length) return std::nullopt;
    Record record{file_.read(at + 4, *header), at + 8 + *header, *length};
    if (record.end() > file_.size()) return std::nullopt;
    return record;
  }

  void scan() {
    scan_records(
        file_, kMagic.size(), file_.size(), [this](std::uint64_t at) { return record_at(at); },
        [this](std::uint64_t at, const Record& record) { add_record(at, record); });
    add_messages_of_unindexed_chunk();
    name_topics();
  }

  void add_record(std::uint64_t at, const Record& record) {
    const Fields fields(record.header, file_.path());
    if (fields.op() == Op::kIndex) {
      add_index(fields, record, chunk_);
      indexed_ = true;
      return;
    }
    add_messages_of_unindexed_chunk();
    if (fields.op() == Op::kChunk) {
      chunk_ = at;
      indexed_ = false;
    }
    if (fields.op() == Op::kConnection) add_connection(fields, record);
  }

  // The last chunk of a bag that was cut off has no index.
  void add_messages_of_unindexed_chunk() {
    if (indexed_) return;
    indexed_ = true;
    try {
      add_messages_of(chunk_);
    } catch (const InputError& e) {
      note(fmt::format("{}; what is whole in it is used", e.what()));
    }
  }

  void add_index(const Fields& fields, const Record& record, std::uint64_t chunk) {
    if (fields.number<std::uint32_t>("ver") != 1) {
      throw InputError(file_.path() + ": an index of a version that is not known");
    }
    const auto topic = fields.number<std::uint32_t>("conn");
    const std::string bytes = file_.read(record.data, record.length);
    ByteReader reader(bytes, file_.path());
    for (auto left = fields.number<std::uint32_t>("count"); left > 0; --left) {
      const std::int64_t time = nanoseconds(reader);
      add_entry({topic, time, 0, chunk, reader.number<std::uint32_t>()});
    }
  }

  void add_messages_of(std::uint64_t position) {
    const std::string& chunk = chunk_at(position);
    ByteReader reader(chunk, file_.path());
    while (!reader.at_end()) {
      const std::uint64_t offset = reader.position();
      const Fields fields(reader.string(), file_.path());
      const std::string_view data = reader.string();
      if (fields.op() == Op::kConnection) {
        connections_[fields.number<std::uint32_t>("conn")] = topic_of(fields, data);
      } else if (fields.op() == Op::kMessage) {
        ByteReader time(fields.text("time"), file_.path());
        add_entry({fields.number<std::uint32_t>("conn"), nanoseconds(time), 0, position, offset});
      }
    }
  }

  void add_connection(const Fields& fields, const Record& record) {
    connections_[fields.number<std::uint32_t>("conn")] =
        topic_of(fields, file_.read(record.data, record.length));
  }

  BagTopic topic_of(const Fields& fields, std::string_view data) const {
    const Fields connection(data, file_.path());
    return {std::string(fields.text("topic")),
            without_msg_folder(std::string(connection.text("type"))), MessageEncoding::kRos1, 0};
  }

  // Entries name connections so far; a topic may have several. What a cut-off table left unnamed is
  // in the chunks.
  void name_topics() {
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      if (connections_.count(entries_[i].topic) == 0) learn_connections(entries_[i].chunk);
    }
    std::unordered_map<std::string, std::uint32_t> by_name;
    std::vector<BagEntry> named;
    for (BagEntry entry : entries_) {
      const auto found = connections_.find(entry.topic);
      if (found == connections_.end()) continue;
      const auto [it, is_new] =
          by_name.try_emplace(found->second.name, static_cast<std::uint32_t>(topics_.size()));
      if (is_new) topics_.push_back(found->second);
      entry.topic = it->second;
      named.push_back(entry);
    }
    if (named.size() < entries_.size()) {
      note(fmt::format("{}: {} messages of no known topic were left out", file_.path(),
                       entries_.size() - named.size()));
    }
    entries_ = std::move(named);
  }

  void learn_connections(std::uint64_t position) try {
    if (!learnt_.insert(position).second) return;
    const std::string& chunk = chunk_at(position);
    ByteReader reader(chunk, file_.path());
    while (!reader.at_end()) {
      const Fields fields(reader.string(), file_.path());
      const std::string_view data = reader.string();
      if (fields.op() != Op::kConnection) continue;
      connections_[fields.number<std::uint32_t>("conn")] = topic_of(fields, data);
    }
  } catch (const InputError& e) {
    note(fmt::format("{}; its messages are left out", e.what()));
  }

  Record chunk_record(std::uint64_t position) const {
    std::optional<Record> record = record_at(position);
    if (!record || Fields(record->header, file_.path()).op() != Op::kChunk) {
      throw InputError(file_.path() + ": damaged index, it points at no chunk");
    }
    return std::move(*record);
  }

  std::string unpack(std::uint64_t position) const override {
    const Record record = chunk_record(position);
    const Fields fields(record.header, file_.path());
    return decompress(file_.read(record.data, record.length),
                      std::string(fields.text("compression")), fields.number<std::uint32_t>("size"),
                      fmt::format("{}: chunk at byte {}", file_.path(), position));
  }

  RandomAccessFile file_;
  std::uint64_t chunk_ = 0;  // while scanning: the one that index records are of
  bool indexed_ = true;      // whether it has had some
  std::unordered_map<std::uint32_t, BagTopic> connections_;
  std::unordered_set<std::uint64_t> learnt_;  // chunks searched for connections
};

}  // namespace

std::unique_ptr<BagFile> open_ros1_bag(const std::string& file) {
  return std::make_unique<Ros1Bag>(file);
}

}  // namespace dxslam
