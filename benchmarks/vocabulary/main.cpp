// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors

// Times of vocabulary and database, all in one thread: loading and quantising with a made-up tree
// of 100 000 words, and queries in a database of up to 100 000 made-up keyframes. usage:
// vocabulary_benchmark OUT_FOLDER [KEYFRAMES]

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>

#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>

#include "io/primitives/atomic_file.h"
#include "vocabulary/bow_database.h"
#include "vocabulary/vocabulary.h"
#include "vocabulary/vocabulary_tree.h"

namespace dxslam {
namespace {

constexpr int kBranching = 10;
constexpr int kDepth = 5;  // 10^5 words
constexpr int kDimension = 64;
constexpr int kDescriptors = 1000;  // of one image
// Words drawn for an image: real ones with 1000 descriptors have 660 to 690 different words, as
// many descriptors of one image are alike.
constexpr int kDraws = 720;

// Milliseconds that this thread has computed, or that have passed. They are the same on an idle
// machine; on a busy one the first still says what the work costs.
double ms_of(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

class Stopwatch {
 public:
  double cpu_ms() const { return ms_of(CLOCK_THREAD_CPUTIME_ID) - cpu_start_; }
  double wall_ms() const { return ms_of(CLOCK_MONOTONIC) - wall_start_; }

 private:
  double cpu_start_ = ms_of(CLOCK_THREAD_CPUTIME_ID);
  double wall_start_ = ms_of(CLOCK_MONOTONIC);
};

struct Times {
  std::vector<double> cpu;
  std::vector<double> wall;

  void add(const Stopwatch& watch) {
    cpu.push_back(watch.cpu_ms());
    wall.push_back(watch.wall_ms());
  }
};

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

std::string text_of(const Times& times) {
  return fmt::format("{:.2f} ms CPU ({:.2f} ms wall)", quantile(times.cpu, 0.5),
                     quantile(times.wall, 0.5));
}

nlohmann::ordered_json json_of(const Times& times) {
  return {{"median_cpu_ms", quantile(times.cpu, 0.5)},
          {"median_wall_ms", quantile(times.wall, 0.5)},
          {"p95_cpu_ms", quantile(times.cpu, 0.95)}};
}

// `row` moved by noise of length `spread`, back on the unit sphere.
cv::Mat near(const cv::Mat& row, float spread, std::mt19937& random) {
  std::normal_distribution<float> normal(0.0F, spread / std::sqrt(static_cast<float>(kDimension)));
  cv::Mat result = row.clone();
  for (int d = 0; d < result.cols; ++d) result.at<float>(0, d) += normal(random);
  return result / cv::norm(result);
}

// A full tree in which children lie around their parent, closer at each level.
VocabularyTree make_tree(std::mt19937& random) {
  VocabularyTree tree;
  tree.name = "synthetic";
  tree.branching = kBranching;
  tree.nodes.emplace_back();
  tree.descriptors = cv::Mat::zeros(1, kDimension, CV_32F);
  std::uint32_t level_begin = 0;
  float spread = 4.0F;
  for (int level = 0; level < kDepth; ++level, spread *= 0.6F) {
    const auto level_end = static_cast<std::uint32_t>(tree.nodes.size());
    for (std::uint32_t parent = level_begin; parent < level_end; ++parent) {
      const cv::Mat centre = tree.descriptors.row(static_cast<int>(parent)).clone();
      for (int c = 0; c < kBranching; ++c) {
        tree.nodes[parent].children.push_back(static_cast<std::uint32_t>(tree.nodes.size()));
        tree.nodes.emplace_back();
        tree.nodes.back().parent = parent;
        tree.nodes.back().weight = 1.0F;
        tree.descriptors.push_back(near(centre, spread, random));
      }
    }
    level_begin = level_end;
  }
  number_words(tree);
  return tree;
}

// Descriptors of an image: each near a word drawn at random.
cv::Mat make_image(const VocabularyTree& tree, std::mt19937& random) {
  std::uniform_int_distribution<std::size_t> node(1, tree.nodes.size() - 1);
  cv::Mat descriptors;
  for (int i = 0; i < kDescriptors; ++i) {
    descriptors.push_back(near(tree.descriptors.row(static_cast<int>(node(random))), 0.3F, random));
  }
  return descriptors;
}

nlohmann::ordered_json time_vocabulary(const std::string& folder) {
  constexpr int kRounds = 41;
  std::mt19937 random(1);
  const VocabularyTree tree = make_tree(random);
  const std::string path = folder + "/synthetic.fbow";
  Vocabulary::from_tree(tree).save(path);
  Times load;
  Times to_first_query;
  Times quantise;
  for (int round = 0; round < kRounds; ++round) {
    const cv::Mat image = make_image(tree, random);
    const Stopwatch loading;
    const Vocabulary vocabulary = Vocabulary::load(path);
    load.add(loading);
    vocabulary.transform(image.row(0));
    to_first_query.add(loading);
    const cv::Mat next = make_image(tree, random);
    const Stopwatch quantising;
    vocabulary.transform(next);
    quantise.add(quantising);
  }
  const VocabularyInfo info = Vocabulary::load(path).info();
  fmt::print("{} words of {} floats, {:.1f} MB (medians of {}):\n", info.words, info.dimension,
             static_cast<double>(info.bytes) / 1e6, kRounds);
  fmt::print("  load                     {}\n", text_of(load));
  fmt::print("  load to first query      {}\n", text_of(to_first_query));
  fmt::print("  {} descriptors to BoW  {}\n", kDescriptors, text_of(quantise));
  return {{"words", info.words},
          {"dimension", info.dimension},
          {"file_bytes", info.bytes},
          {"load", json_of(load)},
          {"load_to_first_query", json_of(to_first_query)},
          {"quantise_1000", json_of(quantise)}};
}

// Draws images of words whose frequencies fall by rank as they do in the hololens walk with the
// shipped vocabulary: the most frequent is in four of ten images, the median one in one of twenty.
// Weights are the idf that follows.
class ImageSource {
 public:
  ImageSource(WordId words, unsigned seed) : random_(seed) {
    std::vector<double> share(words);
    double total = 0.0;
    for (WordId i = 0; i < words; ++i) {
      const double rank = 10000.0 * i / words;
      total += share[i] = std::pow(rank + 30.0, -0.3) * std::exp(-rank / 5500.0);
    }
    for (double& s : share) {
      const double in_image = 1.0 - std::pow(1.0 - s / total, kDraws);
      idf_.push_back(static_cast<float>(-std::log(in_image)));
    }
    word_ = std::discrete_distribution<WordId>(share.begin(), share.end());
  }
  BowVector image() {
    std::vector<std::pair<WordId, float>> entries;
    for (int i = 0; i < kDraws; ++i) {
      const WordId word = word_(random_);
      entries.emplace_back(word, idf_[word]);
    }
    return make_bow_vector(std::move(entries));
  }

 private:
  std::mt19937 random_;
  std::vector<float> idf_;
  std::discrete_distribution<WordId> word_;
};

// Of a database of one size, in ms of one core's work unless said otherwise.
struct QueryTimes {
  std::size_t keyframes = 0;
  double median_ms = 0.0;
  double p95_ms = 0.0;
  double max_ms = 0.0;
  double median_wall_ms = 0.0;  // as passed on the clock
};

QueryTimes time_queries(const BowDatabase& database, ImageSource& source) {
  constexpr int kQueries = 60;
  const auto last = static_cast<std::uint32_t>(database.size());
  Times times;
  for (int i = 0; i < kQueries; ++i) {
    const BowVector query = source.image();
    const Stopwatch watch;
    // The newest thirty stand for the neighbours of the keyframe that asks.
    const auto found = database.query(query, 10, [&](std::uint32_t id) { return id + 30 > last; });
    times.add(watch);
    if (found.size() != 10) throw std::runtime_error("a query found too little");
  }
  return {database.size(), quantile(times.cpu, 0.5), quantile(times.cpu, 0.95),
          quantile(times.cpu, 1.0), quantile(times.wall, 0.5)};
}

// By rising number of keyframes.
std::vector<QueryTimes> time_database(WordId words, std::size_t keyframes) {
  std::vector<QueryTimes> sizes;
  ImageSource source(words, 7);
  BowDatabase database;
  std::size_t postings = 0;
  for (std::size_t i = 0; i < keyframes; ++i) {
    const BowVector image = source.image();
    postings += image.words.size();
    database.add(static_cast<std::uint32_t>(i), image);
    if ((i + 1) % (keyframes / 20) != 0) continue;
    sizes.push_back(time_queries(database, source));
  }
  const QueryTimes& last = sizes.back();
  fmt::print(
      "vocabulary of {} words, {} keyframes of {:.0f} words: median {:.2f} ms CPU ({:.2f} ms "
      "wall), 95 % {:.2f} ms, "
      "max {:.2f} ms\n",
      words, last.keyframes, static_cast<double>(postings) / static_cast<double>(keyframes),
      last.median_ms, last.median_wall_ms, last.p95_ms, last.max_ms);
  return sizes;
}

void run(const std::string& folder, std::size_t keyframes) {
  std::filesystem::create_directories(folder);
  nlohmann::ordered_json report{{"vocabulary", time_vocabulary(folder)}};
  for (const WordId words : {10000U, 100000U}) {
    for (const QueryTimes& times : time_database(words, keyframes)) {
      report["database"][std::to_string(words)].push_back({{"keyframes", times.keyframes},
                                                           {"median_ms", times.median_ms},
                                                           {"median_wall_ms", times.median_wall_ms},
                                                           {"p95_ms", times.p95_ms},
                                                           {"max_ms", times.max_ms}});
    }
  }
  write_file_atomically(folder + "/summary.json", report.dump(2) + "\n");
}

}  // namespace
}  // namespace dxslam

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    fmt::print(stderr, "usage: {} OUT_FOLDER [KEYFRAMES]\n", argv[0]);
    return 2;
  }
  try {
    const long keyframes = argc > 2 ? std::strtol(argv[2], nullptr, 10) : 100000;
    if (keyframes < 200) throw std::runtime_error("KEYFRAMES must be 200 or more");
    dxslam::run(argv[1], static_cast<std::size_t>(keyframes));
  } catch (const std::exception& error) {
    fmt::print(stderr, "vocabulary_benchmark: {}\n", error.what());
    return 1;
  }
  return 0;
}
