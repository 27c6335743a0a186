// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// ROS 2 bags in SQLite: a table of topics and a table of messages.
#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <unordered_map>

#include "core/error.h"
#include "io/bags/decompress.h"
#include "io/bags/indexed_bag.h"
#include "io/bags/random_access_file.h"
#include "io/primitives/limits.h"

namespace dxslam {
namespace {

constexpr std::string_view kMagic("SQLite format 3\0", 16);

/// A prepared statement, stepped through row by row.
class Query {
 public:
  Query(sqlite3* database, const char* text, const std::string& path)
      : database_(database), path_(path) {
    if (sqlite3_prepare_v2(database, text, -1, &statement_, nullptr) != SQLITE_OK) fail();
  }
  ~Query() { sqlite3_finalize(statement_); }
  Query(const Query&) = delete;
  Query& operator=(const Query&) = delete;

  bool next() {
    const int result = sqlite3_step(statement_);
    if (result != SQLITE_ROW && result != SQLITE_DONE) fail();
    return result == SQLITE_ROW;
  }
  void restart_for(std::int64_t id) {
    sqlite3_reset(statement_);
    sqlite3_bind_int64(statement_, 1, id);
  }
  std::int64_t integer(int column) const { return sqlite3_column_int64(statement_, column); }
  std::string text(int column) const {
    const unsigned char* bytes = sqlite3_column_text(statement_, column);
    return bytes == nullptr ? "" : reinterpret_cast<const char*>(bytes);
  }
  std::string blob(int column) const {
    const void* bytes = sqlite3_column_blob(statement_, column);
    const int size = sqlite3_column_bytes(statement_, column);
    return bytes == nullptr
               ? ""
               : std::string(static_cast<const char*>(bytes), static_cast<std::size_t>(size));
  }

 private:
  [[noreturn]] void fail() const {
    const std::string_view why = sqlite3_errmsg(database_);  // may quote a schema of many lines
    throw InputError(
        fmt::format("{}: unusable ROS 2 bag: {}", path_, why.substr(0, why.find('\n'))));
  }
  sqlite3* database_;
  std::string path_;
  sqlite3_stmt* statement_ = nullptr;
};

class SqliteBag : public IndexedBag {
 public:
  explicit SqliteBag(const std::string& path) : path_(path), database_(open(path)) {
    std::unordered_map<std::int64_t, std::uint32_t> index_of;
    Query topics(database_.get(), "SELECT id, name, type, serialization_format FROM topics", path);
    while (topics.next()) {
      index_of[topics.integer(0)] = static_cast<std::uint32_t>(topics_.size());
      topics_.push_back({topics.text(1), without_msg_folder(topics.text(2)),
                         topics.text(3) == "ros1" ? MessageEncoding::kRos1 : MessageEncoding::kCdr,
                         0});
    }
    add_messages(index_of);
    finish_index(path);
    message_ = std::make_unique<Query>(database_.get(),
                                       "SELECT data FROM messages WHERE rowid = ?1", path);
  }

  std::string read(const BagEntry& entry) override {
    message_->restart_for(static_cast<std::int64_t>(entry.offset));
    if (!message_->next()) throw InputError(path_ + ": a message has gone from the bag");
    std::string bytes = message_->blob(0);
    return is_zstd(bytes) ? decompress_zstd(bytes, path_) : bytes;
  }

  std::string read_start(const BagEntry& entry, std::size_t count) override {
    sqlite3_blob* made = nullptr;
    const int result = sqlite3_blob_open(database_.get(), "main", "messages", "data",
                                         static_cast<sqlite3_int64>(entry.offset), 0, &made);
    const std::unique_ptr<sqlite3_blob, decltype(&sqlite3_blob_close)> blob(made,
                                                                            sqlite3_blob_close);
    if (result != SQLITE_OK) return read(entry);
    std::string bytes(std::min(count, static_cast<std::size_t>(sqlite3_blob_bytes(made))), '\0');
    if (sqlite3_blob_read(made, bytes.data(), static_cast<int>(bytes.size()), 0) != SQLITE_OK ||
        is_zstd(bytes)) {
      return read(entry);
    }
    return bytes;
  }

 private:
  struct Close {
    void operator()(sqlite3* database) const { sqlite3_close(database); }
  };
  // Bags compressed message by message do not say so here, but a CDR message begins with a zero.
  static bool is_zstd(const std::string& bytes) {
    return bytes.compare(0, 4, "\x28\xB5\x2F\xFD") == 0;
  }
  using Database = std::unique_ptr<sqlite3, Close>;

  static Database connect(const std::string& path, const char* how) {
    std::string uri = "file:";
    for (const char c : std::filesystem::absolute(path).lexically_normal().string()) {
      uri += c == '%' || c == '?' || c == '#' ? fmt::format("%{:02X}", c) : std::string(1, c);
    }
    sqlite3* made = nullptr;
    const int result = sqlite3_open_v2((uri + how).c_str(), &made,
                                       SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
    Database database(made);
    if (result != SQLITE_OK) {
      throw InputError(fmt::format("{}: cannot be opened: {}", path, sqlite3_errstr(result)));
    }
    // A hostile file is no program: its views and triggers are not run.
    sqlite3_db_config(made, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
    sqlite3_db_config(made, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
    sqlite3_db_config(made, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_db_config(made, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_limit(made, SQLITE_LIMIT_LENGTH, static_cast<int>(limits::kBagChunkBytes));
    return database;
  }

  static Database open(const std::string& path) {
    const RandomAccessFile file(path);
    if (file.size() < kMagic.size() || file.read(0, kMagic.size()) != kMagic) {
      throw InputError(fmt::format("{}: no SQLite file, expected a ROS 2 bag", path));
    }
    // A recorder that was killed may leave a journal with the last messages. Otherwise the file is
    // taken as it is, which needs no lock and writes nothing beside it.
    std::error_code error;
    const bool journal = std::filesystem::exists(path + "-wal", error) ||
                         std::filesystem::exists(path + "-journal", error);
    Database database = connect(path, journal ? "" : "?immutable=1");
    if (journal && sqlite3_exec(database.get(), "SELECT 1 FROM topics", nullptr, nullptr,
                                nullptr) != SQLITE_OK) {
      database = connect(path, "?immutable=1");
    }
    return database;
  }

  // A bag that was cut off fails at some row; those before are whole.
  void add_messages(const std::unordered_map<std::int64_t, std::uint32_t>& index_of) {
    try {
      Query rows(database_.get(), "SELECT rowid, topic_id, timestamp FROM messages", path_);
      while (rows.next()) {
        const auto topic = index_of.find(rows.integer(1));
        if (topic == index_of.end()) continue;
        add_entry(
            {topic->second, rows.integer(2), 0, 0, static_cast<std::uint64_t>(rows.integer(0))});
      }
    } catch (const InputError& e) {
      if (entries_.empty()) throw;
      note(fmt::format("{}; the {} messages before are used", e.what(), entries_.size()));
    }
  }

  std::string unpack(std::uint64_t) const override { return {}; }  // there are no chunks

  std::string path_;
  Database database_;
  std::unique_ptr<Query> message_;
};

}  // namespace

std::unique_ptr<BagFile> open_sqlite_bag(const std::string& file) {
  return std::make_unique<SqliteBag>(file);
}

}  // namespace dxslam
