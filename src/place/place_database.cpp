// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "place/place_database.h"

#include "core/error.h"

namespace dxslam {

void PlaceDatabase::add(std::uint32_t id, const BowVector& bow, const std::vector<float>& global) {
  require(!contains(id), "a place that is in the database already");
  if (!global.empty()) globals_.add(id, global);
  words_.add(id, bow);
  ids_.insert(id);
}

void PlaceDatabase::remove(std::uint32_t id) {
  if (ids_.erase(id) == 0) return;
  words_.remove(id);
  globals_.remove(id);
}

void PlaceDatabase::clear() { *this = PlaceDatabase(); }

std::vector<BowMatch> PlaceDatabase::by_words(const BowVector& bow, std::size_t k,
                                              const PlaceExclusion& excluded) const {
  return words_.query(bow, k, excluded);
}

}  // namespace dxslam
