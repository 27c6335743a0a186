// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "relocalization/group_matching.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <unordered_map>

#include "matching/descriptor_distance.h"

namespace dxslam {
namespace {

constexpr float kNone = -std::numeric_limits<float>::max();
constexpr double kSamePlace = 0.05;  // metres between points that are no rivals

// Two points of one row each, best first.
struct Nearest {
  int point = -1;
  int rival = -1;
  float best = kNone;
  float second = kNone;
};

Nearest nearest_points(const float* similarities, const GroupPoints& group) {
  Nearest nearest;
  for (std::size_t row = 0; row < group.point_of_row.size(); ++row) {
    if (similarities[row] <= nearest.second) continue;
    const int point = group.point_of_row[row];
    if (similarities[row] > nearest.best) {
      if (point != nearest.point) {
        nearest.rival = nearest.point;
        nearest.second = nearest.best;
      }
      nearest.point = point;
      nearest.best = similarities[row];
    } else if (point != nearest.point) {
      nearest.rival = point;
      nearest.second = similarities[row];
    }
  }
  return nearest;
}

bool has_rival(const Nearest& nearest, const GroupPoints& group, float ratio, bool binary) {
  if (nearest.rival < 0 || ratio >= 1.0F) return false;
  const float best = distance_of_similarity(nearest.best, binary);
  if (best < ratio * distance_of_similarity(nearest.second, binary)) return false;
  const auto& positions = group.positions;
  return (positions[static_cast<std::size_t>(nearest.point)] -
          positions[static_cast<std::size_t>(nearest.rival)])
             .norm() > kSamePlace;
}

}  // namespace

GroupPoints gather_group_points(const Map& map, const std::vector<KeyframeId>& keyframes,
                                int descriptors_per_point, int max_rows, float max_distance) {
  GroupPoints group;
  std::unordered_map<PointId, std::vector<int>> rows_of;
  int rows = 0;
  cv::Mat& gathered = group.descriptors;
  for (const KeyframeId id : keyframes) {
    const Keyframe& keyframe = map.keyframe(id);
    const cv::Mat& descriptors = keyframe.frame->descriptors;
    if (gathered.empty() && !descriptors.empty())
      gathered.create(max_rows, descriptors.cols, descriptors.type());
    for (std::size_t k = 0; k < keyframe.points.size(); ++k) {
      if (keyframe.points[k] == kNoId) continue;
      if (rows >= max_rows) break;
      std::vector<int>& known = rows_of[keyframe.points[k]];
      if (static_cast<int>(known.size()) >= descriptors_per_point) continue;
      const int keypoint = static_cast<int>(k);
      const bool alike = std::any_of(known.begin(), known.end(), [&](int row) {
        return descriptor_distance(gathered, row, descriptors, keypoint) < max_distance / 3.0F;
      });
      if (alike) continue;
      int point = 0;
      if (known.empty()) {
        point = static_cast<int>(group.ids.size());
        group.ids.push_back(keyframe.points[k]);
        group.positions.push_back(map.point(keyframe.points[k]).position);
      } else {
        point = group.point_of_row[static_cast<std::size_t>(known.front())];
      }
      known.push_back(rows);
      std::memcpy(gathered.ptr(rows++), descriptors.ptr(keypoint),
                  gathered.elemSize() * static_cast<std::size_t>(gathered.cols));
      group.point_of_row.push_back(point);
    }
  }
  if (!gathered.empty()) gathered = gathered.rowRange(0, rows);
  return group;
}

std::vector<GroupMatch> match_group(const cv::Mat& frame_descriptors, int max_keypoints,
                                    const GroupPoints& group, float max_distance, float ratio) {
  std::vector<GroupMatch> matches;
  if (frame_descriptors.empty() || group.ids.empty()) return matches;
  const cv::Mat wanted =
      frame_descriptors.rowRange(0, std::min(max_keypoints, frame_descriptors.rows));
  const std::size_t columns = group.point_of_row.size();
  std::vector<float> similarity(static_cast<std::size_t>(wanted.rows) * columns);
  descriptor_similarities(wanted, group.descriptors, similarity.data());

  const bool binary = wanted.depth() != CV_32F;
  std::vector<Nearest> nearest(static_cast<std::size_t>(wanted.rows));
  std::vector<float> best_of_column(columns, kNone);
  for (std::size_t k = 0; k < nearest.size(); ++k) {
    const float* row = similarity.data() + k * columns;
    nearest[k] = nearest_points(row, group);
    for (std::size_t j = 0; j < columns; ++j) {
      best_of_column[j] = std::max(best_of_column[j], row[j]);
    }
  }
  // A point belongs to the keypoint that one of its descriptors is nearest to.
  std::vector<float> best_of_point(group.ids.size(), kNone);
  for (std::size_t j = 0; j < columns; ++j) {
    float& best = best_of_point[static_cast<std::size_t>(group.point_of_row[j])];
    best = std::max(best, best_of_column[j]);
  }
  for (std::size_t k = 0; k < nearest.size(); ++k) {
    const Nearest& n = nearest[k];
    if (n.point < 0 || n.best < best_of_point[static_cast<std::size_t>(n.point)]) continue;
    const float distance = distance_of_similarity(n.best, binary);
    if (distance > max_distance || has_rival(n, group, ratio, binary)) continue;
    matches.push_back({static_cast<int>(k), n.point, distance});
  }
  return matches;
}

}  // namespace dxslam
