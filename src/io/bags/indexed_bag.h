// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "io/bags/bag_file.h"
#include "io/bags/random_access_file.h"

namespace dxslam {

/// What the containers share: a list of messages, in chunks of which the last ones read are kept
/// unpacked.
class IndexedBag : public BagFile {
 public:
  const std::vector<BagTopic>& topics() const override { return topics_; }
  const std::vector<BagEntry>& entries() const override { return entries_; }
  const std::vector<std::string>& notes() const override { return notes_; }

 protected:
  /// Throws InputError if there are more than limits::kBagMessages.
  void add_entry(const BagEntry& entry);
  /// Sorts the entries by time and counts them; throws InputError if there is none.
  void finish_index(const std::string& file);
  /// The unpacked chunk at `position`.
  const std::string& chunk_at(std::uint64_t position);
  /// Throws InputError.
  virtual std::string unpack(std::uint64_t position) const = 0;
  void note(std::string sentence) { notes_.push_back(std::move(sentence)); }

  /// Calls add(at, record) with what record_at(at) finds, record behind record, from byte `at` to
  /// `end`. Where a record is cut off (nothing was found) or damaged (either threw InputError), the
  /// rest is left and a note says so.
  template <class RecordAt, class Add>
  void scan_records(const RandomAccessFile& file, std::uint64_t at, std::uint64_t end,
                    const RecordAt& record_at, const Add& add) {
    try {
      while (at < end) {
        const auto record = record_at(at);
        if (!record) {
          note(fmt::format("{}: cut off, what is whole up to byte {} of {} is used", file.path(),
                           at, file.size()));
          return;
        }
        add(at, *record);
        at = record->end();
      }
    } catch (const InputError& e) {
      note(fmt::format("{}; what lies before byte {} is used", e.what(), at));
    }
  }

  std::vector<BagTopic> topics_;
  std::vector<BagEntry> entries_;

 private:
  std::vector<std::string> notes_;
  // Colour and depth of one frame may lie in two chunks. 0 is the position of none, for every file
  // has a magic first.
  struct Chunk {
    std::uint64_t position = 0;
    std::string bytes;
  };
  Chunk last_, before_;
};

}  // namespace dxslam
