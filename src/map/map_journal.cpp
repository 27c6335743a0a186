// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map/map_journal.h"

#include <algorithm>
#include <iterator>

namespace dxslam {
namespace {

template <class Id>
void sort_unique(std::vector<Id>& ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

template <class Id>
std::vector<Id> without(const std::vector<Id>& ids, const std::vector<Id>& others) {
  std::vector<Id> rest;
  std::set_difference(ids.begin(), ids.end(), others.begin(), others.end(),
                      std::back_inserter(rest));
  return rest;
}

}  // namespace

template <class Id>
void Journal<Id>::take(std::vector<Id>& added, std::vector<Id>& moved, std::vector<Id>& removed) {
  for (std::vector<Id>* list : {&added_, &moved_, &removed_}) sort_unique(*list);
  added = without(added_, removed_);
  removed = without(removed_, added_);
  moved = without(without(moved_, removed_), added_);
  clear();
}

template class Journal<std::uint32_t>;

}  // namespace dxslam
