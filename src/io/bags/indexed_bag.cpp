// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/bags/indexed_bag.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "io/primitives/limits.h"

namespace dxslam {

void IndexedBag::add_entry(const BagEntry& entry) {
  if (entries_.size() == limits::kBagMessages) {
    throw InputError(fmt::format("more than {} messages, expected less", limits::kBagMessages));
  }
  entries_.push_back(entry);
}

void IndexedBag::finish_index(const std::string& file) {
  if (entries_.empty()) {
    throw InputError(fmt::format("{}: no whole message in it, expected a recording", file));
  }
  std::stable_sort(entries_.begin(), entries_.end(), [](const BagEntry& a, const BagEntry& b) {
    return a.recorded_ns < b.recorded_ns;
  });
  for (const BagEntry& entry : entries_) ++topics_[entry.topic].messages;
}

const std::string& IndexedBag::chunk_at(std::uint64_t position) {
  if (last_.position == position) return last_.bytes;
  std::swap(last_, before_);
  if (last_.position == position) return last_.bytes;
  last_ = {};
  last_ = {position, unpack(position)};
  return last_.bytes;
}

}  // namespace dxslam
