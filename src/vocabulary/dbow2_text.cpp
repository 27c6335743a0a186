// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "vocabulary/dbow2_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <vector>

#include "core/error.h"
#include "io/primitives/lfs_pointer.h"
#include "io/primitives/text_file.h"

namespace dxslam {
namespace {

constexpr int kMaxBranching = 65535;
constexpr int kMaxDepth = 64;
constexpr std::size_t kMaxNodes = 50'000'000;
constexpr std::size_t kMaxDimension = 65536;

// Takes a text apart line by line, and lines into numbers, without copying either.
class Lines {
 public:
  Lines(std::string_view text, const std::string& where) : rest_(text), where_(where) {}

  /// Goes to the next line that is not blank; false at the end.
  bool next() {
    while (!rest_.empty()) {
      const std::size_t end = rest_.find('\n');
      line_ = rest_.substr(0, end);
      rest_ = end == std::string_view::npos ? std::string_view() : rest_.substr(end + 1);
      ++number_;
      skip_blanks();
      if (!line_.empty()) return true;
    }
    return false;
  }

  bool at_end() const { return line_.empty(); }

  std::string_view field() {
    const std::size_t end = std::min(line_.find_first_of(" \t\r"), line_.size());
    const std::string_view field = line_.substr(0, end);
    line_.remove_prefix(end);
    skip_blanks();
    return field;
  }

  template <class Number>
  Number number(const char* meaning, double min, double max) {
    const std::string_view text = field();
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || error != std::errc() || end != text.data() + text.size() ||
        !(static_cast<double>(value) >= min && static_cast<double>(value) <= max)) {
      fail(fmt::format("{} is {}, expected a number of {:g} to {:g}", meaning, in_quotes(text), min,
                       max));
    }
    return value;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", at_line(where_, number_), what));
  }

  std::string_view line() const { return line_; }

 private:
  void skip_blanks() {
    line_.remove_prefix(std::min(line_.find_first_not_of(" \t\r"), line_.size()));
  }

  std::string_view rest_;
  std::string_view line_;
  std::string where_;
  int number_ = 0;
};

// How the descriptors of the file are written, from the first node: parent, leaf, d..., weight.
struct RowFormat {
  std::size_t dimension = 0;
  bool binary = true;
};

RowFormat row_format(Lines lines) {
  std::vector<std::string_view> fields;
  while (!lines.at_end() && fields.size() <= kMaxDimension) fields.push_back(lines.field());
  if (fields.size() < 4 || fields.size() > kMaxDimension) {
    lines.fail(fmt::format("has {} fields, expected parent, leaf, the descriptor and weight",
                           fields.size()));
  }
  RowFormat format;
  format.dimension = fields.size() - 3;
  for (std::size_t i = 2; i + 1 < fields.size(); ++i) {
    int value = 0;
    const char* end = fields[i].data() + fields[i].size();
    const auto parsed = std::from_chars(fields[i].data(), end, value);
    if (parsed.ec != std::errc() || parsed.ptr != end || value < 0 || value > 255) {
      format.binary = false;
    }
  }
  return format;
}

// Descriptors grow with the nodes, as their number is not known beforehand.
struct Rows {
  RowFormat format;
  std::vector<std::uint8_t> bytes;
  std::vector<float> floats;

  void skip_root() {
    bytes.resize(format.binary ? format.dimension : 0);
    floats.resize(format.binary ? 0 : format.dimension);
  }
  void read(Lines& lines) {
    for (std::size_t i = 0; i < format.dimension; ++i) {
      if (format.binary) {
        bytes.push_back(static_cast<std::uint8_t>(lines.number<int>("descriptor", 0, 255)));
      } else {
        floats.push_back(lines.number<float>("descriptor", -1e30, 1e30));
      }
    }
  }
  cv::Mat matrix(std::size_t count) {
    void* data = format.binary ? static_cast<void*>(bytes.data()) : floats.data();
    return cv::Mat(static_cast<int>(count), static_cast<int>(format.dimension),
                   format.binary ? CV_8U : CV_32F, data)
        .clone();
  }
};

void read_node(Lines& lines, VocabularyTree& tree, Rows& rows, std::vector<char>& leaf) {
  const auto index = static_cast<std::uint32_t>(tree.nodes.size());
  if (index >= kMaxNodes) lines.fail(fmt::format("has more than {} nodes", kMaxNodes));
  VocabularyTree::Node node;
  node.parent = static_cast<std::uint32_t>(lines.number<long>("parent", 0, index - 1.0));
  const bool is_leaf = lines.number<int>("leaf flag", 0, 1) != 0;
  rows.read(lines);
  const auto weight = lines.number<float>("weight", 0, 1e30);
  if (!lines.at_end()) {
    lines.fail(
        fmt::format("has more fields than the {} of the first node", rows.format.dimension + 3));
  }
  if (is_leaf) node.weight = weight;
  VocabularyTree::Node& parent = tree.nodes[node.parent];
  if (leaf[node.parent]) lines.fail(fmt::format("has parent {}, which is a leaf", node.parent));
  if (parent.children.size() >= static_cast<std::size_t>(tree.branching)) {
    lines.fail(fmt::format("is one child of node {} more than the {} that the first line allows",
                           node.parent, tree.branching));
  }
  parent.children.push_back(index);
  tree.nodes.push_back(std::move(node));
  leaf.push_back(is_leaf ? 1 : 0);
}

void check_leaves(const VocabularyTree& tree, const std::vector<char>& leaf,
                  const std::string& where) {
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    if (leaf[i] || !tree.is_word(i)) continue;
    throw InputError(fmt::format(
        "{}: node {} is no leaf but has no children, is the file cut short?", where, i));
  }
}

// Nodes in the order of their lines: parents before children and words by their ids, as the format
// numbers them by their lines; and children of a node as they are, wherever the ids allow it.
class LineOrder {
 public:
  explicit LineOrder(const VocabularyTree& tree)
      : tree_(tree), placed_(tree.nodes.size(), 0), next_child_(tree.nodes.size(), 0) {
    place(0);
    for (const std::uint32_t word : words_by_id()) place_word(word);
  }
  std::vector<std::uint32_t> nodes;

 private:
  std::vector<std::uint32_t> words_by_id() const {
    std::vector<std::uint32_t> words;
    for (std::uint32_t i = 0; i < tree_.nodes.size(); ++i) {
      if (tree_.is_word(i)) words.push_back(i);
    }
    std::stable_sort(words.begin(), words.end(), [&](std::uint32_t a, std::uint32_t b) {
      return tree_.nodes[a].word < tree_.nodes[b].word;
    });
    return words;
  }

  void place_word(std::uint32_t word) {
    std::vector<std::uint32_t> path;
    for (std::uint32_t node = word; !placed_[node]; node = tree_.nodes[node].parent) {
      path.push_back(node);
    }
    for (; !path.empty(); path.pop_back()) {
      place_inner_siblings_before(path.back());
      if (!placed_[path.back()]) place(path.back());
    }
  }

  void place_inner_siblings_before(std::uint32_t node) {
    const std::uint32_t parent = tree_.nodes[node].parent;
    const std::vector<std::uint32_t>& siblings = tree_.nodes[parent].children;
    std::size_t& next = next_child_[parent];
    while (next < siblings.size()) {
      const std::uint32_t sibling = siblings[next++];
      if (sibling == node) break;
      if (!placed_[sibling] && !tree_.is_word(sibling)) place(sibling);
    }
  }

  void place(std::uint32_t node) {
    placed_[node] = 1;
    nodes.push_back(node);
  }

  const VocabularyTree& tree_;
  std::vector<char> placed_;
  std::vector<std::size_t> next_child_;  // of each node, the first child not looked at
};

int depth_of(const VocabularyTree& tree) {
  std::vector<int> level(tree.nodes.size(), 0);
  for (std::size_t i = 1; i < tree.nodes.size(); ++i) level[i] = level[tree.nodes[i].parent] + 1;
  return *std::max_element(level.begin(), level.end());
}

// The branching factor.
int read_head(Lines& lines) {
  const int branching = lines.number<int>("branching factor", 1, kMaxBranching);
  lines.number<int>("depth", 1, kMaxDepth);
  lines.number<int>("scoring", 0, 5);
  lines.number<int>("weighting", 0, 3);
  return branching;
}

}  // namespace

bool is_dbow2_text(std::string_view text) {
  Lines lines(without_byte_order_mark(text.substr(0, text.find('\n'))), "");
  try {
    if (!lines.next()) return false;
    read_head(lines);
    return lines.at_end();
  } catch (const InputError&) {
    return false;
  }
}

VocabularyTree parse_dbow2_text(std::string_view text, const std::string& where) {
  Lines lines(without_byte_order_mark(text), where);
  if (!lines.next()) {
    throw InputError(
        fmt::format("{}: is empty, expected a vocabulary (FBoW or DBoW2 text)", where));
  }
  const std::string_view head = lines.line().substr(0, 64);
  if (head.find_first_not_of("0123456789 \t\r") != std::string_view::npos) {
    lines.fail(fmt::format("begins with {}, expected a vocabulary (FBoW or DBoW2 text){}",
                           in_quotes(head.substr(0, 20)), lfs_hint(text)));
  }
  VocabularyTree tree;
  tree.branching = read_head(lines);
  tree.nodes.emplace_back();
  std::vector<char> leaf{0};
  Rows rows;
  while (lines.next()) {
    if (tree.nodes.size() == 1) {
      rows.format = row_format(lines);
      rows.skip_root();
    }
    read_node(lines, tree, rows, leaf);
  }
  check_leaves(tree, leaf, where);
  tree.descriptors = rows.matrix(tree.nodes.size());
  number_words(tree);
  return tree;
}

std::string format_dbow2_text(const VocabularyTree& tree) {
  const std::vector<std::uint32_t> order = LineOrder(tree).nodes;
  std::vector<std::uint32_t> line_of(tree.nodes.size(), 0);
  for (std::uint32_t line = 0; line < order.size(); ++line) line_of[order[line]] = line;
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{} {} 0 0\n", tree.branching, depth_of(tree));
  for (std::size_t line = 1; line < order.size(); ++line) {
    const VocabularyTree::Node& node = tree.nodes[order[line]];
    const int row = static_cast<int>(order[line]);
    fmt::format_to(out, "{} {}", line_of[node.parent], node.children.empty() ? 1 : 0);
    for (int d = 0; d < tree.descriptors.cols; ++d) {
      if (tree.descriptors.depth() == CV_8U) {
        fmt::format_to(out, " {}", tree.descriptors.at<std::uint8_t>(row, d));
      } else {
        // Always with a point, so that no row of round numbers is taken for bytes.
        fmt::format_to(out, " {:#.9g}", tree.descriptors.at<float>(row, d));
      }
    }
    fmt::format_to(out, " {:.9g}\n", node.weight);
  }
  return text;
}

}  // namespace dxslam
