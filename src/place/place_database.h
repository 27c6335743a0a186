// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "vocabulary/bow_database.h"
#include "vocabulary/bow_vector.h"

namespace dxslam {

/// Places that must not be found, e.g. those covisible with the query; empty = none.
using PlaceExclusion = std::function<bool(std::uint32_t id)>;

/// L2 distance of two global descriptors of unit length and equal size, 0 to 2: from their inner
/// product, as the paper has it (III.E).
double global_distance(const std::vector<float>& a, const std::vector<float>& b);

struct GlobalMatch {
  std::uint32_t id = 0;
  double distance = 0.0;  ///< global_distance of query and place
};

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

  bool contains(std::uint32_t id) const { return slot_of_.count(id) != 0; }
  std::size_t size() const { return slot_of_.size(); }
  /// Whether the place is there and has a global descriptor.
  bool has_global(std::uint32_t id) const;

  /// The `k` most similar places by words, as BowDatabase::query.
  std::vector<BowMatch> by_words(const BowVector& bow, std::size_t k,
                                 const PlaceExclusion& excluded = {}) const;
  /// The `k` nearest places by global descriptor, by rising distance and then id.
  std::vector<GlobalMatch> by_global(const std::vector<float>& global, std::size_t k,
                                     const PlaceExclusion& excluded = {}) const;
  /// Distance of the query to one place. Throws ContractError if it is not there, or either has no
  /// global descriptor.
  double distance_to(std::uint32_t id, const std::vector<float>& global) const;

 private:
  double distance_at(std::size_t slot, const std::vector<float>& global) const;

  BowDatabase words_;
  std::size_t dimension_ = 0;      // of the global descriptors; 0 until the first
  std::vector<float> globals_;     // by slot, dimension_ numbers each; zero where there is none
  std::vector<char> has_global_;   // by slot
  std::vector<std::uint32_t> id_;  // by slot
  std::unordered_map<std::uint32_t, std::size_t> slot_of_;
};

}  // namespace dxslam
