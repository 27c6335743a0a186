// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "vocabulary/descriptor_clustering.h"

#include <algorithm>

#include "core/error.h"
#include "matching/descriptor_distance.h"
#include "vocabulary/descriptor_mean.h"

namespace dxslam {
namespace {

constexpr int kChunk = 4096;            // rows whose similarities are held at a time
constexpr int kSeedRowsACluster = 100;  // seeds are chosen among so many rows a cluster

float weight_of(const std::vector<float>& weight, int row) {
  return weight.empty() ? 1.0F : weight[static_cast<std::size_t>(row)];
}

// Adds a row to the centres where `least` is the squared distance of each row to those before.
void take_seed(const cv::Mat& rows, int row, cv::Mat& centres, std::vector<float>& least) {
  centres.push_back(rows.row(row));
  std::vector<float> similarity(static_cast<std::size_t>(rows.rows));
  descriptor_similarities(rows, rows.row(row), similarity.data());
  const bool binary = rows.depth() == CV_8U;
  for (std::size_t i = 0; i < least.size(); ++i) {
    const float distance = distance_of_similarity(similarity[i], binary);
    least[i] = std::min(least[i], distance * distance);
  }
  least[static_cast<std::size_t>(row)] = 0.0F;  // rounding must not let a row be taken twice
}

// Seeds far from each other: each next row is drawn by its squared distance to the nearest one
// before it (k-means++).
cv::Mat choose_seeds(const cv::Mat& rows, const std::vector<float>& weight, int k,
                     std::mt19937_64& random) {
  cv::Mat centres(0, rows.cols, rows.type());
  std::vector<float> least(static_cast<std::size_t>(rows.rows), 1e30F);
  take_seed(rows, std::uniform_int_distribution<int>(0, rows.rows - 1)(random), centres, least);
  std::vector<double> sums(least.size());
  while (centres.rows < k) {
    double total = 0.0;
    for (std::size_t i = 0; i < least.size(); ++i) {
      // Equal rows may be a rounding error apart, which must not make them clusters.
      if (least[i] > 1e-6F) total += least[i] * weight_of(weight, static_cast<int>(i));
      sums[i] = total;
    }
    if (total <= 0.0) break;
    const double drawn = std::uniform_real_distribution<double>(0.0, total)(random);
    const auto at = std::upper_bound(sums.begin(), sums.end() - 1, drawn);
    take_seed(rows, static_cast<int>(at - sums.begin()), centres, least);
  }
  return centres;
}

cv::Mat choose_seeds_of_sample(const cv::Mat& rows, const std::vector<float>& weight, int k,
                               std::mt19937_64& random) {
  const int most = k * kSeedRowsACluster;
  if (rows.rows <= most) return choose_seeds(rows, weight, k, random);
  cv::Mat sample(0, rows.cols, rows.type());
  std::vector<float> sample_weight;
  sample.reserve(static_cast<std::size_t>(most));
  for (int i = 0; i < most; ++i) {
    const auto row = static_cast<int>(std::int64_t{i} * rows.rows / most);
    sample.push_back(rows.row(row));
    if (!weight.empty()) sample_weight.push_back(weight_of(weight, row));
  }
  return choose_seeds(sample, sample_weight, k, random);
}

// Gives each row to its nearest centre; true if any label changed.
bool assign(const cv::Mat& rows, const cv::Mat& centres, std::vector<int>& label) {
  const auto k = static_cast<std::size_t>(centres.rows);
  std::vector<float> similarity(static_cast<std::size_t>(std::min(kChunk, rows.rows)) * k);
  bool changed = false;
  for (int first = 0; first < rows.rows; first += kChunk) {
    const int last = std::min(first + kChunk, rows.rows);
    descriptor_similarities(rows.rowRange(first, last), centres, similarity.data());
    for (int i = first; i < last; ++i) {
      const float* row = similarity.data() + static_cast<std::size_t>(i - first) * k;
      const int nearest = static_cast<int>(std::max_element(row, row + k) - row);
      changed = changed || nearest != label[static_cast<std::size_t>(i)];
      label[static_cast<std::size_t>(i)] = nearest;
    }
  }
  return changed;
}

// Centres of the groups that have members; the others stay where they are.
void move_centres(const cv::Mat& rows, const std::vector<float>& weight,
                  const std::vector<int>& label, cv::Mat& centres) {
  DescriptorMeans means(rows.depth() == CV_8U, rows.cols);
  for (int c = 0; c < centres.rows; ++c) means.open();
  for (int i = 0; i < rows.rows; ++i) {
    means.add(static_cast<std::size_t>(label[static_cast<std::size_t>(i)]), rows, i,
              weight_of(weight, i));
  }
  const cv::Mat moved = means.means();
  for (int c = 0; c < centres.rows; ++c) {
    if (means.total(static_cast<std::size_t>(c)) > 0.0F) moved.row(c).copyTo(centres.row(c));
  }
}

void drop_empty(Clustering& clusters) {
  std::vector<int> new_label(static_cast<std::size_t>(clusters.centres.rows), -1);
  for (const int label : clusters.label) new_label[static_cast<std::size_t>(label)] = 0;
  cv::Mat kept(0, clusters.centres.cols, clusters.centres.type());
  for (int c = 0; c < clusters.centres.rows; ++c) {
    if (new_label[static_cast<std::size_t>(c)] < 0) continue;
    new_label[static_cast<std::size_t>(c)] = kept.rows;
    kept.push_back(clusters.centres.row(c));
  }
  for (int& label : clusters.label) label = new_label[static_cast<std::size_t>(label)];
  clusters.centres = kept;
}

}  // namespace

Clustering cluster_descriptors(const cv::Mat& descriptors, const std::vector<float>& weight, int k,
                               int iterations, std::mt19937_64& random) {
  require(descriptors.rows > 0 && k > 0, "there must be descriptors to cluster");
  require(weight.empty() || weight.size() == static_cast<std::size_t>(descriptors.rows),
          "there must be one weight a descriptor");
  Clustering clusters;
  clusters.centres = choose_seeds_of_sample(descriptors, weight, k, random);
  clusters.label.assign(static_cast<std::size_t>(descriptors.rows), -1);
  assign(descriptors, clusters.centres, clusters.label);
  for (int i = 0; i < iterations; ++i) {
    move_centres(descriptors, weight, clusters.label, clusters.centres);
    if (!assign(descriptors, clusters.centres, clusters.label)) break;
  }
  drop_empty(clusters);
  return clusters;
}

}  // namespace dxslam
