// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map/removed_keyframes.h"

#include <type_traits>

#include "core/pose_numbers.h"

namespace dxslam {
namespace {

constexpr std::size_t kMostInMemory = 4096;

struct Record {
  PoseNumbers parent_from_camera;
  std::uint64_t parent;
};
static_assert(std::is_trivially_copyable_v<Record> && sizeof(Record) == 64);

std::uint64_t place_in_file(KeyframeId id) { return std::uint64_t{id} * sizeof(Record); }

}  // namespace

void RemovedKeyframes::add(KeyframeId id, const Place& place) {
  in_memory_.insert(id, place);
  order_.push_back(id);
  while (order_.size() > kMostInMemory) {
    const KeyframeId oldest = order_.front();
    const Place& p = *in_memory_.find(oldest);
    const Record record{numbers_of(p.parent_from_camera), p.parent};
    if (!file_.write(&record, sizeof record, place_in_file(oldest))) return;
    in_memory_.erase(oldest);
    order_.pop_front();
  }
}

RemovedKeyframes::Place RemovedKeyframes::find(KeyframeId id) const {
  if (const Place* place = in_memory_.find(id)) return *place;
  Record record;
  file_.read(&record, sizeof record, place_in_file(id));
  return {static_cast<KeyframeId>(record.parent), pose_of(record.parent_from_camera)};
}

}  // namespace dxslam
