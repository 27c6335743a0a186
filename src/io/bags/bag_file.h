// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace dxslam {

/// How the bytes of a message are laid out: as ROS 1 does it, or as ROS 2 (OMG CDR).
enum class MessageEncoding { kRos1, kCdr };

struct BagTopic {
  std::string name;
  std::string type;  ///< "package/Message", also where the file says "package/msg/Message"
  MessageEncoding encoding = MessageEncoding::kRos1;
  std::size_t messages = 0;
};

/// Where a message lies. Made by BagFile; only the file that made it can read it.
struct BagEntry {
  std::uint32_t topic = 0;       ///< index into BagFile::topics()
  std::int64_t recorded_ns = 0;  ///< when it was written down, nanoseconds
  std::uint32_t part = 0;        ///< file of a split bag
  std::uint64_t chunk = 0;       ///< byte of the chunk in the file, or of the record without one
  std::uint64_t offset = 0;      ///< byte in the chunk, or row of a table
};

/// Messages recorded by somebody else: ROS 1 bags (version 2.0), ROS 2 bags in SQLite or MCAP. No
/// ROS is needed. Opening reads indexes only, as far as the file has them. A file that was cut off
/// (a recorder that was killed, a full disk) gives all messages that are whole. One thread at a
/// time.
class BagFile {
 public:
  virtual ~BagFile() = default;
  virtual const std::vector<BagTopic>& topics() const = 0;
  /// All messages by rising time of recording.
  virtual const std::vector<BagEntry>& entries() const = 0;
  /// The bytes of one message. Throws InputError if they are damaged.
  virtual std::string read(const BagEntry& entry) = 0;
  /// Its first `count` bytes, or more of it: cheap where nothing is compressed.
  virtual std::string read_start(const BagEntry& entry, std::size_t count) = 0;
  /// Sentences on what is wrong with the file though it can be used.
  virtual const std::vector<std::string>& notes() const = 0;
};

/// Whether `path` is something open_bag() reads: a file that begins as one of the containers or has
/// the name of one (.bag, .mcap, .db3), or a folder with metadata.yaml of ROS 2 or such files.
bool is_bag(const std::string& path);

/// Opens a bag file, told apart by its content, or the folder of a ROS 2 bag, of one file or split
/// into several. Throws InputError, one sentence, for a file that is none or has no whole message,
/// and for a folder of several bags.
std::unique_ptr<BagFile> open_bag(const std::string& path);

// One function per container, each in a file of its own.
std::unique_ptr<BagFile> open_ros1_bag(const std::string& file);
std::unique_ptr<BagFile> open_mcap(const std::string& file);
std::unique_ptr<BagFile> open_sqlite_bag(const std::string& file);

/// "sensor_msgs/msg/Image" and "sensor_msgs/Image" are one type: the latter.
std::string without_msg_folder(const std::string& type);

}  // namespace dxslam
