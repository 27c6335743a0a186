// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace dxslam {

/// Items by ids that rise, of which most are removed again: takes the memory of what lives (and 8
/// bytes per 4096 ids up to the largest), and a look-up is three steps. Items
/// stay where they are until they are removed. Const as a pointer is: the items of a const table
/// may be changed. As thread-safe as std::vector.
template <class T>
class IdTable {
 public:
  using Id = std::uint32_t;
  static constexpr Id kLastId = 0xFFFFFFFEU;

  /// Null if there is none of this id.
  T* find(Id id) const {
    const std::size_t branch = id / kBranchIds;
    if (branch >= branches_.size() || !branches_[branch]) return nullptr;
    const Leaf* leaf = branches_[branch]->leaves[id / kWidth % kWidth].get();
    return leaf == nullptr ? nullptr : leaf->items[id % kWidth].get();
  }

  /// The first id from `from` on that is free; behind the last one come those from 0 on.
  Id free_from(Id from) const {
    for (Id id = from;; ++id) {
      if (id > kLastId) id = 0;
      if (find(id) == nullptr) return id;
    }
  }

  /// Puts an item where there is none. Returns it.
  T& insert(Id id, T item) {
    const std::size_t number = id / kBranchIds;
    if (number >= branches_.size()) branches_.resize(number + 1);
    if (!branches_[number]) branches_[number] = std::make_unique<Branch>();
    Branch& branch = *branches_[number];
    std::unique_ptr<Leaf>& leaf = branch.leaves[id / kWidth % kWidth];
    if (!leaf) {
      leaf = std::make_unique<Leaf>();
      ++branch.used;
    }
    std::unique_ptr<T>& slot = leaf->items[id % kWidth];
    slot = std::make_unique<T>(std::move(item));
    ++leaf->used;
    ++size_;
    return *slot;
  }

  /// The item must be there.
  void erase(Id id) {
    std::unique_ptr<Branch>& branch = branches_[id / kBranchIds];
    std::unique_ptr<Leaf>& leaf = branch->leaves[id / kWidth % kWidth];
    leaf->items[id % kWidth].reset();
    --size_;
    if (--leaf->used > 0) return;
    leaf.reset();
    if (--branch->used == 0) branch.reset();
  }

  std::size_t size() const { return size_; }

  /// Calls visit(id, item) by rising id.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (std::size_t b = 0; b < branches_.size(); ++b) {
      if (!branches_[b]) continue;
      for (std::size_t l = 0; l < kWidth; ++l) {
        const Leaf* leaf = branches_[b]->leaves[l].get();
        for (std::size_t i = 0; leaf != nullptr && i < kWidth; ++i) {
          if (leaf->items[i]) {
            visit(static_cast<Id>(b * kBranchIds + l * kWidth + i), *leaf->items[i]);
          }
        }
      }
    }
  }

 private:
  // Small, since in the end few of the ids that one holds are still alive.
  static constexpr std::size_t kWidth = 64;
  static constexpr std::size_t kBranchIds = kWidth * kWidth;

  struct Leaf {
    std::array<std::unique_ptr<T>, kWidth> items;
    std::size_t used = 0;
  };
  struct Branch {
    std::array<std::unique_ptr<Leaf>, kWidth> leaves;
    std::size_t used = 0;
  };

  std::vector<std::unique_ptr<Branch>> branches_;
  std::size_t size_ = 0;
};

}  // namespace dxslam
