// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_set>
#include <vector>

#include "place/global_index.h"
#include "vocabulary/bow_database.h"
#include "vocabulary/bow_vector.h"

namespace dxslam {

/// Images of known places by their visual words and by their global descriptors (paper III.E).
/// Any number of threads may query at a time, or one may change it.
class PlaceDatabase {
 public:
  /// `bow` or `global` may be empty where nothing will ask for them. Throws ContractError if `id`
  /// is in the database already or `global` differs in size from those before.
  void add(std::uint32_t id, const BowVector& bow, const std::vector<float>& global);
  /// Does nothing if `id` is not there.
  void remove(std::uint32_t id);
  void clear();

  bool contains(std::uint32_t id) const { return ids_.count(id) != 0; }
  std::size_t size() const { return ids_.size(); }
  /// Of the places that have one.
  const GlobalIndex& globals() const { return globals_; }

  /// The `k` most similar places by words, as BowDatabase::query.
  std::vector<BowMatch> by_words(const BowVector& bow, std::size_t k,
                                 const PlaceExclusion& excluded = {}) const;

 private:
  BowDatabase words_;
  GlobalIndex globals_;
  std::unordered_set<std::uint32_t> ids_;
};

}  // namespace dxslam
