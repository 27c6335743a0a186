// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "place/place_database.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace dxslam {
namespace {

double distance_of(const float* a, const float* b, std::size_t size) {
  const auto n = static_cast<Eigen::Index>(size);
  const double product =
      Eigen::Map<const Eigen::VectorXf>(a, n).dot(Eigen::Map<const Eigen::VectorXf>(b, n));
  return std::sqrt(std::max(0.0, 2.0 - 2.0 * product));
}

}  // namespace

double global_distance(const std::vector<float>& a, const std::vector<float>& b) {
  require(a.size() == b.size() && !a.empty(), "global descriptors of different or no size");
  return distance_of(a.data(), b.data(), a.size());
}

void PlaceDatabase::add(std::uint32_t id, const BowVector& bow, const std::vector<float>& global) {
  require(!contains(id), "a place that is in the database already");
  require(global.empty() || dimension_ == 0 || global.size() == dimension_,
          "a global descriptor of another size than those before");
  if (dimension_ == 0 && !global.empty()) {
    dimension_ = global.size();
    globals_.resize(id_.size() * dimension_, 0.0F);
  }
  words_.add(id, bow);
  slot_of_[id] = id_.size();
  id_.push_back(id);
  has_global_.push_back(global.empty() ? 0 : 1);
  globals_.insert(globals_.end(), global.begin(), global.end());
  globals_.resize(id_.size() * dimension_, 0.0F);
}

void PlaceDatabase::remove(std::uint32_t id) {
  const auto found = slot_of_.find(id);
  if (found == slot_of_.end()) return;
  words_.remove(id);
  // The last place moves into the gap.
  const std::size_t slot = found->second;
  const std::size_t last = id_.size() - 1;
  slot_of_.erase(found);
  if (slot != last) {
    id_[slot] = id_[last];
    has_global_[slot] = has_global_[last];
    slot_of_[id_[slot]] = slot;
    std::copy_n(globals_.begin() + static_cast<std::ptrdiff_t>(last * dimension_), dimension_,
                globals_.begin() + static_cast<std::ptrdiff_t>(slot * dimension_));
  }
  id_.pop_back();
  has_global_.pop_back();
  globals_.resize(last * dimension_);
}

void PlaceDatabase::clear() { *this = PlaceDatabase(); }

bool PlaceDatabase::has_global(std::uint32_t id) const {
  const auto found = slot_of_.find(id);
  return found != slot_of_.end() && has_global_[found->second] != 0;
}

std::vector<BowMatch> PlaceDatabase::by_words(const BowVector& bow, std::size_t k,
                                              const PlaceExclusion& excluded) const {
  return words_.query(bow, k, excluded);
}

std::vector<GlobalMatch> PlaceDatabase::by_global(const std::vector<float>& global, std::size_t k,
                                                  const PlaceExclusion& excluded) const {
  if (dimension_ == 0 || global.empty()) return {};
  require(global.size() == dimension_, "a global descriptor of another size than the places'");
  std::vector<GlobalMatch> matches;
  for (std::size_t slot = 0; slot < id_.size(); ++slot) {
    if (has_global_[slot] == 0 || (excluded && excluded(id_[slot]))) continue;
    matches.push_back({id_[slot], distance_at(slot, global)});
  }
  const auto nearer = [](const GlobalMatch& a, const GlobalMatch& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.id < b.id;
  };
  const std::size_t kept = std::min(k, matches.size());
  std::partial_sort(matches.begin(), matches.begin() + static_cast<std::ptrdiff_t>(kept),
                    matches.end(), nearer);
  matches.resize(kept);
  return matches;
}

double PlaceDatabase::distance_to(std::uint32_t id, const std::vector<float>& global) const {
  const auto found = slot_of_.find(id);
  require(found != slot_of_.end(), "a place that is not in the database");
  require(has_global_[found->second] != 0 && global.size() == dimension_,
          "a place or query without a global descriptor of the database's size");
  return distance_at(found->second, global);
}

double PlaceDatabase::distance_at(std::size_t slot, const std::vector<float>& global) const {
  return distance_of(globals_.data() + slot * dimension_, global.data(), dimension_);
}

}  // namespace dxslam
