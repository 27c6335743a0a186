// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "vocabulary/bow_vector.h"

namespace dxslam {

struct BowMatch {
  std::uint32_t id = 0;
  double score = 0.0;  ///< bow_score of query and entry
};

/// Images by their visual words: an inverted index, so that a query looks only at images that share
/// a word with it (paper III.E). Any number of threads may query at a time, or one may change it.
class BowDatabase {
 public:
  /// Throws ContractError if `id` is in the database already.
  void add(std::uint32_t id, const BowVector& vector);
  /// Does nothing if `id` is not there.
  void remove(std::uint32_t id);
  void clear();

  bool contains(std::uint32_t id) const { return slot_of_.count(id) != 0; }
  std::size_t size() const { return slot_of_.size(); }

  /// The `k` images of highest score, by falling score and then rising id, without those that share
  /// no word with the query or that `excluded` is true for. Scores are exactly those of
  /// bow_score().
  std::vector<BowMatch> query(const BowVector& vector, std::size_t k,
                              const std::function<bool(std::uint32_t)>& excluded = {}) const;

 private:
  // Images get slots in the order of their arrival; a removed one leaves its slot empty until
  // compact(), so that postings need not be searched for it.
  struct Posting {
    std::uint32_t slot;
    float weight;
  };

  void compact();

  std::vector<std::vector<Posting>> postings_;  // by word, each by rising slot
  std::vector<std::uint32_t> id_of_;            // by slot
  std::vector<char> used_;                      // by slot
  std::unordered_map<std::uint32_t, std::uint32_t> slot_of_;
};

}  // namespace dxslam
