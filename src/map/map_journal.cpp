// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map/map_journal.h"

#include <algorithm>
#include <iterator>

namespace dxslam {
namespace {

using Ids = std::vector<Journal::Id>;

void sort_unique(Ids& ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

Ids without(const Ids& ids, const Ids& others) {
  Ids rest;
  std::set_difference(ids.begin(), ids.end(), others.begin(), others.end(),
                      std::back_inserter(rest));
  return rest;
}

}  // namespace

void Journal::take(Ids& added, Ids& moved, Ids& removed) {
  for (Ids* list : {&added_, &moved_, &removed_}) sort_unique(*list);
  added = without(added_, removed_);
  removed = without(removed_, added_);
  moved = without(without(moved_, removed_), added_);
  clear();
}

}  // namespace dxslam
