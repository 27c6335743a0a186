// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "vocabulary/fbow_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <vector>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "core/error.h"
#include "vocabulary/vocabulary_tree.h"

namespace dxslam {
namespace {

constexpr std::uint64_t kMagic = 55824124;
constexpr std::size_t kNameBytes = 50;
constexpr std::size_t kHeaderBytes = 128;                        // magic and parameters
constexpr std::uint64_t kChecksumMagic = 0x32304d55534c5844;     // "DXLSUM02"
constexpr std::uint64_t kOldChecksumMagic = 0x31304d55534c5844;  // "DXLSUM01", no longer verified
constexpr std::size_t kChecksumBytes = 16;
constexpr std::int32_t kTypeBytes = 0;  // OpenCV's CV_8UC1
constexpr std::int32_t kTypeFloat = 5;  // and CV_32FC1
constexpr std::uint32_t kMaxBranching = 65535;
constexpr std::size_t kMaxDescriptorBytes = 1U << 20U;

// Offsets in the file.
enum Offset : std::size_t {
  kAtName = 8,
  kAtAlignment = 60,
  kAtBlocks = 64,
  kAtDescriptorStep = 72,
  kAtBlockStep = 80,
  kAtDescriptorsOffset = 88,
  kAtChildrenOffset = 96,
  kAtTotal = 104,
  kAtType = 112,
  kAtDescriptorBytes = 116,
  kAtBranching = 120,
};

template <class Value>
Value get(std::string_view bytes, std::size_t offset) {
  Value value;
  std::memcpy(&value, bytes.data() + offset, sizeof(value));
  return value;
}

template <class Value>
void put(std::uint8_t* bytes, std::size_t offset, Value value) {
  std::memcpy(bytes + offset, &value, sizeof(value));
}

std::size_t round_up(std::size_t n, std::size_t multiple) {
  return (n + multiple - 1) / multiple * multiple;
}

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw InputError(fmt::format("{}: {}", where, what));
}

FbowLayout read_layout(std::string_view bytes, const std::string& where) {
  if (bytes.size() < kHeaderBytes) {
    refuse(where, fmt::format("has {} bytes, expected an FBoW vocabulary with a header of {}",
                              bytes.size(), kHeaderBytes));
  }
  FbowLayout layout;
  const std::string_view name = bytes.substr(kAtName, kNameBytes);
  layout.name = name.substr(0, name.find('\0'));
  const auto type = get<std::int32_t>(bytes, kAtType);
  if (type != kTypeBytes && type != kTypeFloat) {
    refuse(where,
           fmt::format("has descriptors of type {}, expected 0 (bytes) or 5 (floats)", type));
  }
  layout.binary = type == kTypeBytes;
  layout.branching = get<std::uint32_t>(bytes, kAtBranching);
  layout.blocks = get<std::uint32_t>(bytes, kAtBlocks);
  layout.alignment = get<std::uint32_t>(bytes, kAtAlignment);
  layout.descriptor_bytes = get<std::uint32_t>(bytes, kAtDescriptorBytes);
  layout.descriptor_step = get<std::uint64_t>(bytes, kAtDescriptorStep);
  layout.block_step = get<std::uint64_t>(bytes, kAtBlockStep);
  layout.descriptors_offset = get<std::uint64_t>(bytes, kAtDescriptorsOffset);
  layout.children_offset = get<std::uint64_t>(bytes, kAtChildrenOffset);
  return layout;
}

// After this no product or sum of the layout's numbers exceeds the size of the file.
void check_layout(const FbowLayout& layout, std::string_view bytes, const std::string& where) {
  const std::size_t room = bytes.size() - kHeaderBytes;
  const auto total = get<std::uint64_t>(bytes, kAtTotal);
  if (layout.branching < 1 || layout.branching > kMaxBranching) {
    refuse(where, fmt::format("has a branching factor of {}, expected 1 to {}", layout.branching,
                              kMaxBranching));
  }
  const std::size_t unit = layout.binary ? 1 : sizeof(float);
  if (layout.descriptor_bytes < unit || layout.descriptor_bytes > kMaxDescriptorBytes ||
      layout.descriptor_bytes % unit != 0) {
    refuse(where, fmt::format("has descriptors of {} bytes, expected {} to {}",
                              layout.descriptor_bytes, unit, kMaxDescriptorBytes));
  }
  if (layout.blocks == 0 || layout.block_step == 0 || layout.block_step > room ||
      total != layout.blocks * static_cast<std::uint64_t>(layout.block_step) || total > room) {
    refuse(where, fmt::format("says it has {} blocks of {} bytes, {} in all, and {} bytes follow "
                              "its header",
                              layout.blocks, layout.block_step, total, room));
  }
  const bool step_fits =
      layout.descriptor_step >= layout.descriptor_bytes && layout.descriptor_step <= room;
  const bool offsets_fit = layout.descriptors_offset >= 4 &&
                           layout.descriptors_offset <= layout.block_step &&
                           layout.children_offset <= layout.block_step;
  if (!step_fits || !offsets_fit ||
      layout.descriptors_offset + layout.branching * layout.descriptor_step >
          layout.children_offset ||
      layout.children_offset + std::size_t{layout.branching} * 8 > layout.block_step) {
    refuse(where, fmt::format("says its blocks of {} bytes hold {} descriptors, {} bytes apart, "
                              "from {} and their children from {}, which does not fit",
                              layout.block_step, layout.branching, layout.descriptor_step,
                              layout.descriptors_offset, layout.children_offset));
  }
  if (!layout.binary && (layout.block_step % unit != 0 || layout.descriptor_step % unit != 0 ||
                         layout.descriptors_offset % unit != 0)) {
    refuse(where, "has floats that do not lie at multiples of 4 bytes");
  }
}

void check_end(FbowImage& image, const std::string& where) {
  const std::size_t end = kHeaderBytes + image.layout.blocks * image.layout.block_step;
  const std::size_t rest = image.file.size() - end;
  if (rest == 0) return;
  const auto magic = rest == kChecksumBytes ? get<std::uint64_t>(image.file, end) : 0;
  if (magic == kOldChecksumMagic) return;
  if (magic != kChecksumMagic) {
    refuse(where, fmt::format("has {} bytes behind its {} blocks, expected none or a checksum",
                              rest, image.layout.blocks));
  }
  if (get<std::uint64_t>(image.file, end + 8) != XXH3_64bits(image.file.data(), end)) {
    refuse(where, "does not have the checksum it was written with, the file is damaged");
  }
  image.has_checksum = true;
}

// One child of block `number`: either a word, or a block that no other child leads to.
void check_child(FbowImage& image, std::uint32_t number, const FbowImage::Child& child,
                 std::vector<char>& seen, std::vector<std::uint32_t>& queue,
                 const std::string& where) {
  if (child.is_word()) {
    if (child.index() >= std::uint64_t{image.layout.blocks} * image.layout.branching) {
      refuse(where, fmt::format("block {} has a word of id {}, expected less than the {} places",
                                number, child.index(),
                                std::uint64_t{image.layout.blocks} * image.layout.branching));
    }
    if (!(child.weight >= 0.0F) || !std::isfinite(child.weight)) {
      refuse(where, fmt::format("block {} has a word of weight {}, expected 0 or more", number,
                                child.weight));
    }
    ++image.words;
    image.word_limit = std::max(image.word_limit, child.index() + 1);
    return;
  }
  if (child.index() >= image.layout.blocks || seen[child.index()]) {
    refuse(where, fmt::format("block {} has block {} as a child, expected one of the {} that no "
                              "other leads to",
                              number, child.index(), image.layout.blocks));
  }
  seen[child.index()] = 1;
  queue.push_back(child.index());
}

// Blocks are farther apart than the processor looks ahead by itself.
void fetch_ahead(const FbowImage& image, const std::vector<std::uint32_t>& queue,
                 std::size_t next) {
  constexpr std::size_t kAhead = 12;
  constexpr std::size_t kLine = 64;
  if (next + kAhead >= queue.size()) return;
  const std::uint8_t* block = image.block(queue[next + kAhead]);
  const std::uint8_t* children = block + image.layout.children_offset;
  __builtin_prefetch(block);
  __builtin_prefetch(children);
  if (image.layout.branching * 8 > kLine) __builtin_prefetch(children + kLine);
}

// Walks from the root, level by level.
void check_blocks(FbowImage& image, const std::string& where) {
  std::vector<char> seen(image.layout.blocks, 0);
  std::vector<std::uint32_t> queue{0};
  queue.reserve(image.layout.blocks);
  seen[0] = 1;
  std::size_t level_end = 1;
  image.depth = 1;
  for (std::size_t next = 0; next < queue.size(); ++next) {
    if (next == level_end) {
      level_end = queue.size();
      ++image.depth;
    }
    fetch_ahead(image, queue, next);
    const std::uint32_t number = queue[next];
    const std::uint8_t* block = image.block(number);
    const std::uint32_t count = FbowImage::child_count(block);
    if (count < 1 || count > image.layout.branching) {
      refuse(where, fmt::format("block {} has {} children, expected 1 to {}", number, count,
                                image.layout.branching));
    }
    for (std::uint32_t i = 0; i < count; ++i) {
      check_child(image, number, image.child(block, i), seen, queue, where);
    }
  }
  if (queue.size() != image.layout.blocks) {
    refuse(where, fmt::format("only {} of its {} blocks can be reached from the root", queue.size(),
                              image.layout.blocks));
  }
}

// The layout that the original library computes.
FbowLayout make_layout(const VocabularyTree& tree, std::uint32_t blocks) {
  FbowLayout layout;
  layout.name = tree.name.substr(0, kNameBytes - 1);
  layout.binary = tree.descriptors.depth() == CV_8U;
  layout.branching = static_cast<std::uint32_t>(tree.branching);
  layout.blocks = blocks;
  layout.alignment = layout.binary ? 8 : 32;
  layout.descriptor_bytes =
      tree.descriptors.elemSize() * static_cast<std::size_t>(tree.descriptors.cols);
  layout.descriptor_step = round_up(layout.descriptor_bytes, layout.alignment);
  layout.descriptors_offset = round_up(8, layout.alignment);
  layout.children_offset = layout.descriptors_offset + layout.branching * layout.descriptor_step;
  layout.block_step =
      round_up(layout.children_offset + std::size_t{layout.branching} * 8, layout.alignment);
  return layout;
}

void write_header(const FbowLayout& layout, std::uint8_t* bytes) {
  put(bytes, 0, kMagic);
  std::copy(layout.name.begin(), layout.name.end(), bytes + kAtName);
  put(bytes, kAtAlignment, layout.alignment);
  put(bytes, kAtBlocks, layout.blocks);
  put<std::uint64_t>(bytes, kAtDescriptorStep, layout.descriptor_step);
  put<std::uint64_t>(bytes, kAtBlockStep, layout.block_step);
  put<std::uint64_t>(bytes, kAtDescriptorsOffset, layout.descriptors_offset);
  put<std::uint64_t>(bytes, kAtChildrenOffset, layout.children_offset);
  put<std::uint64_t>(bytes, kAtTotal, layout.blocks * layout.block_step);
  put<std::int32_t>(bytes, kAtType, layout.binary ? kTypeBytes : kTypeFloat);
  put(bytes, kAtDescriptorBytes, static_cast<std::uint32_t>(layout.descriptor_bytes));
  put(bytes, kAtBranching, layout.branching);
}

// Inner nodes level by level, the root first: the order of the original's tree node ids.
std::vector<std::uint32_t> inner_nodes(const VocabularyTree& tree) {
  std::vector<std::uint32_t> order{0};
  for (std::size_t next = 0; next < order.size(); ++next) {
    for (const std::uint32_t child : tree.nodes[order[next]].children) {
      if (!tree.is_word(child)) order.push_back(child);
    }
  }
  return order;
}

void write_block(const VocabularyTree& tree, std::uint32_t node, const FbowLayout& layout,
                 const std::vector<std::uint32_t>& block_of, std::uint8_t* block) {
  const std::vector<std::uint32_t>& children = tree.nodes[node].children;
  const bool only_words = std::all_of(children.begin(), children.end(),
                                      [&](std::uint32_t child) { return tree.is_word(child); });
  put(block, 0, static_cast<std::uint16_t>(children.size()));
  put(block, 2, static_cast<std::uint16_t>(only_words ? 1 : 0));
  put(block, 4, block_of[tree.nodes[node].parent]);
  for (std::size_t i = 0; i < children.size(); ++i) {
    const std::uint32_t child = children[i];
    std::copy_n(tree.descriptors.ptr(static_cast<int>(child)), layout.descriptor_bytes,
                block + layout.descriptors_offset + i * layout.descriptor_step);
    const bool word = tree.is_word(child);
    put(block, layout.children_offset + i * 8,
        word ? tree.nodes[child].word | FbowImage::kWordFlag : block_of[child]);
    put(block, layout.children_offset + i * 8 + 4, word ? tree.nodes[child].weight : 0.0F);
  }
}

std::shared_ptr<std::uint8_t> aligned_zeros(std::size_t size) {
  constexpr std::align_val_t kCacheLine{64};
  std::shared_ptr<std::uint8_t> bytes(static_cast<std::uint8_t*>(::operator new(size, kCacheLine)),
                                      [](std::uint8_t* p) { ::operator delete(p, kCacheLine); });
  std::memset(bytes.get(), 0, size);
  return bytes;
}

}  // namespace

bool is_fbow(std::string_view bytes) {
  return bytes.size() >= sizeof(kMagic) && get<std::uint64_t>(bytes, 0) == kMagic;
}

std::shared_ptr<const FbowImage> parse_fbow(std::string_view bytes,
                                            std::shared_ptr<const void> owner,
                                            const std::string& where) {
  if (!is_fbow(bytes)) refuse(where, "does not begin with the signature of an FBoW vocabulary");
  auto image = std::make_shared<FbowImage>();
  image->layout = read_layout(bytes, where);
  check_layout(image->layout, bytes, where);
  image->file = bytes;
  image->owner = std::move(owner);
  image->first_block = reinterpret_cast<const std::uint8_t*>(bytes.data()) + kHeaderBytes;
  check_end(*image, where);
  check_blocks(*image, where);
  return image;
}

std::shared_ptr<const FbowImage> pack_tree(const VocabularyTree& tree) {
  const std::vector<std::uint32_t> order = inner_nodes(tree);
  const FbowLayout layout = make_layout(tree, static_cast<std::uint32_t>(order.size()));
  std::vector<std::uint32_t> block_of(tree.nodes.size(), 0);
  for (std::uint32_t i = 0; i < order.size(); ++i) block_of[order[i]] = i;

  const std::size_t end = kHeaderBytes + layout.blocks * layout.block_step;
  const std::shared_ptr<std::uint8_t> bytes = aligned_zeros(end + kChecksumBytes);
  write_header(layout, bytes.get());
  for (std::size_t i = 0; i < order.size(); ++i) {
    write_block(tree, order[i], layout, block_of,
                bytes.get() + kHeaderBytes + i * layout.block_step);
  }
  const std::string_view file(reinterpret_cast<const char*>(bytes.get()), end + kChecksumBytes);
  put(bytes.get(), end, kChecksumMagic);
  put(bytes.get(), end + 8, XXH3_64bits(file.data(), end));
  return parse_fbow(file, bytes, "vocabulary in memory");
}

VocabularyTree unpack_tree(const FbowImage& image) {
  const FbowLayout& layout = image.layout;
  VocabularyTree tree;
  tree.name = layout.name;
  tree.branching = static_cast<int>(layout.branching);
  tree.nodes.reserve(image.words + layout.blocks);
  tree.nodes.emplace_back();
  const int dimension = static_cast<int>(layout.dimension());
  tree.descriptors = cv::Mat::zeros(static_cast<int>(image.words + layout.blocks), dimension,
                                    layout.binary ? CV_8U : CV_32F);
  // Blocks in the order they are met, with the node that each is.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> queue{{0U, 0U}};
  for (std::size_t next = 0; next < queue.size(); ++next) {
    const auto [number, node] = queue[next];
    const std::uint8_t* block = image.block(number);
    for (std::uint32_t i = 0; i < FbowImage::child_count(block); ++i) {
      const auto index = static_cast<std::uint32_t>(tree.nodes.size());
      const FbowImage::Child child = image.child(block, i);
      tree.nodes[node].children.push_back(index);
      tree.nodes.emplace_back();
      tree.nodes.back().parent = node;
      std::copy_n(image.descriptor(block, i), layout.descriptor_bytes,
                  tree.descriptors.ptr(static_cast<int>(index)));
      if (child.is_word()) {
        tree.nodes.back().word = child.index();
        tree.nodes.back().weight = child.weight;
      } else {
        queue.emplace_back(child.index(), index);
      }
    }
  }
  return tree;
}

}  // namespace dxslam
