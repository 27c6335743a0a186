// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "matching/descriptor_matching.h"

#include <algorithm>
#include <limits>

#include "core/simd.h"
#include "matching/descriptor_distance.h"

namespace dxslam {
namespace {

constexpr float kNone = -std::numeric_limits<float>::max();

constexpr int kRowsAtOnce = 24;  // of similarities: they stay in the cache

struct Nearest {
  float best = kNone;
  float second = kNone;
  int index = -1;

  // Of equal ones the first is the nearest and the other the second.
  void take(float value, int at) {
    if (value > best || (value == best && at < index)) {
      second = best;
      best = value;
      index = at;
    } else if (value > second) {
      second = value;
    }
  }
};

/// The two largest of a row; what is the largest of its column so far is noted there.
DXSLAM_INLINE_KERNEL Nearest scan_row(const float* row, int n, int i, float* column_best,
                                      int* column_row) {
  FloatLanes best = FloatLanes{} + kNone;
  FloatLanes second = best;
  IntLanes index = {};
  int j = 0;
  for (; j + kSimdLanes <= n; j += kSimdLanes) {
    const FloatLanes value = *reinterpret_cast<const FloatLanes*>(row + j);
    FloatLanes& in_column = *reinterpret_cast<FloatLanes*>(column_best + j);
    IntLanes& of_row = *reinterpret_cast<IntLanes*>(column_row + j);
    const IntLanes leads = value > in_column;
    in_column = leads ? value : in_column;
    of_row = leads ? IntLanes{} + i : of_row;
    const IntLanes nearer = value > best;
    const FloatLanes less = nearer ? best : value;
    second = less > second ? less : second;
    best = nearer ? value : best;
    index = nearer ? IntLanes{} + j : index;
  }
  Nearest nearest;
  for (int lane = 0; lane < kSimdLanes && j > 0; ++lane) {
    nearest.take(best[lane], index[lane] + lane);
    nearest.second = std::max(nearest.second, second[lane]);
  }
  for (; j < n; ++j) {
    if (row[j] > column_best[j]) {
      column_best[j] = row[j];
      column_row[j] = i;
    }
    nearest.take(row[j], j);
  }
  return nearest;
}

struct Table {
  std::vector<Nearest> of_row;
  std::vector<int> column_row;  ///< the nearest row of each column
};

Table nearest_of_all(const cv::Mat& a, const cv::Mat& b) {
  const DescriptorSimilarities similarities(a, b);
  const std::size_t columns = static_cast<std::size_t>(b.rows);
  Table table{std::vector<Nearest>(static_cast<std::size_t>(a.rows)), std::vector<int>(columns)};
  std::vector<float> column_best(columns, kNone);
  std::vector<float> rows(kRowsAtOnce * columns);
  const auto scan = simd_kernel<scan_row>();
  for (int first = 0; first < a.rows; first += kRowsAtOnce) {
    const int end = std::min(first + kRowsAtOnce, a.rows);
    similarities.of_rows(first, end - first, rows.data());
    for (int i = first; i < end; ++i) {
      const float* row = rows.data() + static_cast<std::size_t>(i - first) * columns;
      table.of_row[static_cast<std::size_t>(i)] =
          scan(row, b.rows, i, column_best.data(), table.column_row.data());
    }
  }
  return table;
}

}  // namespace

std::vector<Match> match_mutual(const cv::Mat& a, const cv::Mat& b, float max_distance,
                                float ratio) {
  std::vector<Match> matches;
  if (a.empty() || b.empty()) return matches;
  const Table table = nearest_of_all(a, b);
  const bool binary = a.depth() != CV_32F;
  for (int i = 0; i < a.rows; ++i) {
    const Nearest& nearest = table.of_row[static_cast<std::size_t>(i)];
    if (nearest.index < 0 || table.column_row[static_cast<std::size_t>(nearest.index)] != i) {
      continue;
    }
    const float distance = distance_of_similarity(nearest.best, binary);
    if (distance > max_distance) continue;
    if (nearest.second > kNone && ratio < 1.0F &&
        distance >= ratio * distance_of_similarity(nearest.second, binary)) {
      continue;
    }
    matches.push_back({i, nearest.index, distance});
  }
  return matches;
}

}  // namespace dxslam
