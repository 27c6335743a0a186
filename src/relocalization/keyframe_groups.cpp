// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "relocalization/keyframe_groups.h"

#include <algorithm>

namespace dxslam {
namespace {

constexpr int kVotes = 3;  // members whose similarity counts

int shared_points(const Keyframe& keyframe, KeyframeId other) {
  const auto it = std::lower_bound(
      keyframe.covisibles.begin(), keyframe.covisibles.end(), other,
      [](const Covisible& covisible, KeyframeId id) { return covisible.keyframe < id; });
  return it != keyframe.covisibles.end() && it->keyframe == other ? it->shared : 0;
}

void fill_up(const Map& map, std::size_t size, CandidateGroup& group) {
  const std::size_t wanted = size + group.keyframes.size();  // some are members already
  for (const Covisible& c : map.best_covisibles(group.keyframes.front(), wanted, 1)) {
    if (group.keyframes.size() >= size) return;
    if (std::find(group.keyframes.begin(), group.keyframes.end(), c.keyframe) ==
        group.keyframes.end()) {
      group.keyframes.push_back(c.keyframe);
    }
  }
}

}  // namespace

std::vector<CandidateGroup> group_by_covisibility(const Map& map,
                                                  const std::vector<GlobalMatch>& candidates,
                                                  int min_shared, std::size_t size) {
  std::vector<CandidateGroup> groups;
  std::vector<char> grouped(candidates.size(), 0);
  // What a group gets for a member that it does not have.
  const double floor = candidates.empty() ? 0.0 : static_cast<double>(candidates.back().similarity);
  for (std::size_t first = 0; first < candidates.size(); ++first) {
    if (grouped[first] != 0 || !map.has_keyframe(candidates[first].id)) continue;
    const Keyframe& seed = map.keyframe(candidates[first].id);
    CandidateGroup group;
    group.component = seed.component;
    int votes = 0;
    for (std::size_t i = first; i < candidates.size(); ++i) {
      if (grouped[i] != 0 || (i != first && shared_points(seed, candidates[i].id) < min_shared)) {
        continue;
      }
      grouped[i] = 1;
      if (group.keyframes.size() < size) group.keyframes.push_back(candidates[i].id);
      if (votes++ < kVotes) group.promise += static_cast<double>(candidates[i].similarity);
    }
    group.promise += std::max(0, kVotes - votes) * floor;
    fill_up(map, size, group);
    groups.push_back(std::move(group));
  }
  std::stable_sort(
      groups.begin(), groups.end(),
      [](const CandidateGroup& a, const CandidateGroup& b) { return a.promise > b.promise; });
  return groups;
}

}  // namespace dxslam
