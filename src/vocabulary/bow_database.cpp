// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "vocabulary/bow_database.h"

#include <algorithm>

#include "core/error.h"

namespace dxslam {
namespace {

constexpr std::size_t kMinCompaction = 64;  // empty slots that are not worth a sweep

bool ranks_before(const BowMatch& a, const BowMatch& b) {
  return a.score != b.score ? a.score > b.score : a.id < b.id;
}

}  // namespace

void BowDatabase::add(std::uint32_t id, const BowVector& vector) {
  const auto slot = static_cast<std::uint32_t>(id_of_.size());
  require(slot_of_.emplace(id, slot).second, "an image is in the database already");
  id_of_.push_back(id);
  used_.push_back(1);
  if (vector.empty()) return;
  if (postings_.size() <= vector.words.back().first) {
    postings_.resize(vector.words.back().first + std::size_t{1});
  }
  for (const auto& [word, weight] : vector.words) postings_[word].push_back({slot, weight});
}

void BowDatabase::remove(std::uint32_t id) {
  const auto entry = slot_of_.find(id);
  if (entry == slot_of_.end()) return;
  used_[entry->second] = 0;
  slot_of_.erase(entry);
  if (const std::size_t empty = id_of_.size() - slot_of_.size();
      empty >= kMinCompaction && empty > slot_of_.size()) {
    compact();
  }
}

void BowDatabase::clear() { *this = BowDatabase(); }

void BowDatabase::compact() {
  std::vector<std::uint32_t> new_slot(id_of_.size());
  std::uint32_t next = 0;
  for (std::size_t slot = 0; slot < id_of_.size(); ++slot) {
    new_slot[slot] = next;
    if (!used_[slot]) continue;
    id_of_[next] = id_of_[slot];
    slot_of_[id_of_[next]] = next;
    ++next;
  }
  for (std::vector<Posting>& list : postings_) {
    const auto gone = [&](const Posting& p) { return !used_[p.slot]; };
    list.erase(std::remove_if(list.begin(), list.end(), gone), list.end());
    for (Posting& posting : list) posting.slot = new_slot[posting.slot];
  }
  id_of_.resize(next);
  used_.assign(next, 1);
}

std::vector<BowMatch> BowDatabase::query(const BowVector& vector, std::size_t k,
                                         const std::function<bool(std::uint32_t)>& excluded) const {
  std::vector<double> common(id_of_.size(), 0.0);
  for (const auto& [word, weight] : vector.words) {
    if (word >= postings_.size()) break;
    const float mine = weight;
    for (const Posting& posting : postings_[word]) {
      common[posting.slot] += std::min(mine, posting.weight);
    }
  }
  // A heap of the best so far, the worst of them on top: most images are turned away by one
  // comparison, and `excluded` is asked only about the others.
  std::vector<BowMatch> best;
  for (std::size_t slot = 0; k > 0 && slot < common.size(); ++slot) {
    if (common[slot] <= 0.0 || !used_[slot]) continue;
    const BowMatch match{id_of_[slot], 2.0 * common[slot]};
    const bool full = best.size() == k;
    if (full && !ranks_before(match, best.front())) continue;
    if (excluded && excluded(match.id)) continue;
    if (full) {
      std::pop_heap(best.begin(), best.end(), ranks_before);
      best.pop_back();
    }
    best.push_back(match);
    std::push_heap(best.begin(), best.end(), ranks_before);
  }
  std::sort_heap(best.begin(), best.end(), ranks_before);
  return best;
}

}  // namespace dxslam
