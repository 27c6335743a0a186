// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <vector>

#include "io/bags/bag_file.h"

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
