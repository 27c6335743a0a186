// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "io/primitives/growing_file.h"

namespace dxslam {

/// Writes an MCAP file of the profile ros2: chunks with checksums and indexes, and a summary. Every
/// flush() hands whole chunks to the system: a file whose writer was killed, or whose disk is full,
/// holds all messages up to the last flush(). One thread at a time.
class McapWriter {
 public:
  /// Creates or empties the file. `compression`: "", "zstd" or "lz4". Throws InputError.
  McapWriter(const std::string& path, std::string compression);

  /// A topic of messages of a type ("sensor_msgs/msg/Image"), whose `definition` is written in the
  /// form of ROS 2. Returns the number for add().
  std::uint16_t add_topic(const std::string& topic, const std::string& type,
                          const std::string& definition);
  /// A message in CDR, recorded at `time_ns`, which is positive or 0. In memory until flush().
  void add(std::uint16_t topic, std::uint64_t time_ns, std::string_view message);
  /// Writes a chunk of all messages since the last one. Throws InputError if it could not be
  /// written in full; the file then ends with the chunk before, and these messages are lost.
  void flush();
  /// Writes what is left and the summary. Throws InputError; the file can be read all the same.
  void finish();

 private:
  struct Topic {
    std::string schema, channel;  // their records
    bool in_chunk = false;        // whether these are in the chunk
    std::uint64_t messages = 0;
  };
  struct IndexEntry {
    std::uint64_t time = 0;
    std::uint64_t offset = 0;  // in the chunk
  };
  using Index = std::map<std::uint16_t, std::vector<IndexEntry>>;
  struct Times {
    std::uint64_t first = 0;
    std::uint64_t last = 0;
  };

  void append(const std::string& bytes);
  static std::string index_record(std::uint16_t topic, const std::vector<IndexEntry>& entries);
  std::string statistics() const;

  GrowingFile file_;
  std::string compression_;
  std::uint32_t checksum_ = 0;  // of all that was written
  std::vector<Topic> topics_;   // number 1 first
  std::string chunk_;
  Index index_;  // of the chunk
  Times chunk_times_, times_;
  std::vector<std::string> chunk_indexes_;  // records for the summary
};

}  // namespace dxslam
