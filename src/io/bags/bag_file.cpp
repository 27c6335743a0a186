// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/bags/bag_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string_view>
#include <unordered_map>

#include "core/error.h"
#include "io/bags/random_access_file.h"
#include "io/primitives/limits.h"
#include "io/primitives/name_order.h"
#include "io/primitives/text_file.h"
#include "io/primitives/yaml_text.h"

namespace dxslam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMetadata = "rosbag2_bagfile_information";

enum class Container { kNone, kRos1, kMcap, kSqlite };

struct Kind {
  Container container;
  std::string_view magic;  // first bytes of the file
  const char* suffix;
};
constexpr Kind kKinds[] = {{Container::kRos1, "#ROSBAG V", ".bag"},
                           {Container::kMcap, std::string_view("\x89MCAP0\r\n", 8), ".mcap"},
                           {Container::kSqlite, "SQLite format 3", ".db3"}};

bool has_bag_suffix(const fs::path& path) {
  return std::any_of(std::begin(kKinds), std::end(kKinds),
                     [&](const Kind& kind) { return path.extension() == kind.suffix; });
}

Container container_of(const std::string& file) {
  const RandomAccessFile opened(file);
  const std::string start = opened.read(0, std::min<std::uint64_t>(opened.size(), 16));
  for (const Kind& kind : kKinds) {
    if (start.compare(0, kind.magic.size(), kind.magic) == 0) return kind.container;
  }
  return Container::kNone;
}

std::unique_ptr<BagFile> open_bag_file(const std::string& path) {
  switch (container_of(path)) {
    case Container::kRos1:
      return open_ros1_bag(path);
    case Container::kMcap:
      return open_mcap(path);
    case Container::kSqlite:
      return open_sqlite_bag(path);
    case Container::kNone:
      break;
  }
  const bool packed = fs::path(path).extension() == ".zstd";
  throw InputError(
      fmt::format("{}: no recording known here, expected a ROS 1 bag, an MCAP file or a ROS 2 "
                  "bag in SQLite{}",
                  path, packed ? "; one packed as a whole is unpacked by `zstd -d`" : ""));
}

/// The files of a split ROS 2 bag, as if they were one.
class SplitBag : public BagFile {
 public:
  explicit SplitBag(const std::vector<std::string>& files) {
    for (const std::string& file : files) {
      try {
        add_part(open_bag_file(file));
      } catch (const InputError& e) {
        notes_.push_back(fmt::format("{}; the other files of the bag are used", e.what()));
      }
    }
    if (parts_.empty()) throw InputError(notes_.front());
    std::stable_sort(entries_.begin(), entries_.end(), [](const BagEntry& a, const BagEntry& b) {
      return a.recorded_ns < b.recorded_ns;
    });
  }

  const std::vector<BagTopic>& topics() const override { return topics_; }
  const std::vector<BagEntry>& entries() const override { return entries_; }
  const std::vector<std::string>& notes() const override { return notes_; }
  std::string read(const BagEntry& entry) override { return parts_[entry.part]->read(entry); }
  std::string read_start(const BagEntry& entry, std::size_t count) override {
    return parts_[entry.part]->read_start(entry, count);
  }

 private:
  void add_part(std::unique_ptr<BagFile> part) {
    std::vector<std::uint32_t> own_topics;  // in topics_, by index in the part
    for (const BagTopic& topic : part->topics()) {
      const auto [it, is_new] =
          index_of_.try_emplace(topic.name, static_cast<std::uint32_t>(topics_.size()));
      if (is_new) topics_.push_back({topic.name, topic.type, topic.encoding, 0});
      topics_[it->second].messages += topic.messages;
      own_topics.push_back(it->second);
    }
    for (BagEntry entry : part->entries()) {
      entry.part = static_cast<std::uint32_t>(parts_.size());
      entry.topic = own_topics[entry.topic];
      entries_.push_back(entry);
    }
    notes_.insert(notes_.end(), part->notes().begin(), part->notes().end());
    parts_.push_back(std::move(part));
  }

  std::vector<std::unique_ptr<BagFile>> parts_;
  std::unordered_map<std::string, std::uint32_t> index_of_;  // of a topic's name
  std::vector<BagTopic> topics_;
  std::vector<BagEntry> entries_;
  std::vector<std::string> notes_;
};

bool has_metadata(const std::string& folder) {
  const std::string path = (fs::path(folder) / "metadata.yaml").string();
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return false;
  const RandomAccessFile file(path);
  return file.read(0, std::min<std::uint64_t>(file.size(), 1024)).find(kMetadata) !=
         std::string::npos;
}

std::vector<std::string> files_of_metadata(const std::string& folder) {
  const std::string path = (fs::path(folder) / "metadata.yaml").string();
  const YAML::Node all =
      parse_yaml(read_file(path, "the metadata of a ROS 2 bag", limits::kYamlBytes), path);
  std::vector<std::string> files;
  const YAML::Node list = yaml_child(yaml_child(all, kMetadata), "relative_file_paths");
  for (std::size_t i = 0; list.IsDefined() && list.IsSequence() && i < list.size(); ++i) {
    // Some recorders wrote the bag's own folder in front, so the name alone counts.
    if (!list[i].IsScalar()) continue;
    files.push_back((fs::path(folder) / fs::path(list[i].Scalar()).filename()).string());
  }
  if (!files.empty()) return files;
  throw InputError(path + ": no list relative_file_paths, expected the metadata of a ROS 2 bag");
}

std::vector<std::string> bag_files_in(const std::string& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && has_bag_suffix(entry.path())) files.push_back(entry.path());
  }
  sort_by_name(files);
  std::vector<std::string> names;
  for (const fs::path& file : files) names.push_back(file.string());
  return names;
}

// "walk_3.mcap" is a part of "walk".
std::string name_of_whole(const std::string& file) {
  std::string stem = fs::path(file).stem().string();
  const std::size_t end = stem.find_last_not_of("0123456789");
  if (end != std::string::npos && end + 1 < stem.size() && stem[end] == '_') stem.resize(end);
  return stem;
}

void require_one_bag(const std::string& folder, const std::vector<std::string>& files) {
  for (const std::string& file : files) {
    if (name_of_whole(file) == name_of_whole(files.front())) continue;
    throw InputError(fmt::format("{}: holds several bags, {} and {} among them, expected one",
                                 folder, fs::path(files.front()).filename().string(),
                                 fs::path(file).filename().string()));
  }
}

std::unique_ptr<BagFile> open_bag_folder(const std::string& folder) {
  const bool described = has_metadata(folder);
  const std::vector<std::string> files =
      described ? files_of_metadata(folder) : bag_files_in(folder);
  if (files.empty()) throw InputError(folder + ": no .bag, .mcap or .db3 file in this folder");
  if (!described) require_one_bag(folder, files);
  if (files.size() > 1) return std::make_unique<SplitBag>(files);
  return open_bag_file(files.front());
}

}  // namespace

std::string without_msg_folder(const std::string& type) {
  const std::size_t at = type.find("/msg/");
  return at == std::string::npos ? type : type.substr(0, at) + type.substr(at + 4);
}

bool is_bag(const std::string& path) {
  std::error_code error;
  if (fs::is_regular_file(path, error)) {
    return has_bag_suffix(path) || container_of(path) != Container::kNone;
  }
  if (!fs::is_directory(path, error)) return false;
  if (has_metadata(path)) return true;
  for (fs::directory_iterator it(path, error), end; !error && it != end; it.increment(error)) {
    if (has_bag_suffix(it->path())) return true;
  }
  return false;
}

std::unique_ptr<BagFile> open_bag(const std::string& path) {
  return fs::is_directory(path) ? open_bag_folder(path) : open_bag_file(path);
}

}  // namespace dxslam
