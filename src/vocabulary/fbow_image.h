// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>

#include "vocabulary/bow_vector.h"

namespace dxslam {

struct VocabularyTree;

/// Sizes in the header of an FBoW file (docs/file_formats.md), all in bytes where not said
/// otherwise.
struct FbowLayout {
  std::string name;
  bool binary = false;
  std::uint32_t branching = 0;         ///< most children of a block
  std::uint32_t blocks = 0;            ///< inner nodes of the tree, number 0 is the root
  std::uint32_t alignment = 0;         ///< of blocks and descriptors
  std::size_t descriptor_bytes = 0;    ///< of one descriptor
  std::size_t descriptor_step = 0;     ///< from one descriptor of a block to the next
  std::size_t block_step = 0;          ///< from one block to the next
  std::size_t descriptors_offset = 0;  ///< in a block
  std::size_t children_offset = 0;     ///< in a block

  std::size_t dimension() const {
    return binary ? descriptor_bytes : descriptor_bytes / sizeof(float);
  }
};

/// A vocabulary as the bytes of an FBoW file, whole and checked: every descent from block 0 ends at
/// a word without leaving the bytes. Immutable.
struct FbowImage {
  /// What a block says about one of its children.
  struct Child {
    std::uint32_t bits = 0;
    float weight = 0.0F;

    bool is_word() const { return (bits & kWordFlag) != 0; }
    std::uint32_t index() const { return bits & ~kWordFlag; }  ///< word id, or number of a block
  };
  static constexpr std::uint32_t kWordFlag = 0x80000000U;

  FbowLayout layout;
  const std::uint8_t* first_block = nullptr;
  std::string_view file;              ///< all bytes, with header and checksum
  std::shared_ptr<const void> owner;  ///< keeps them
  bool mapped = false;
  bool has_checksum = false;
  std::size_t words = 0;  ///< leaves
  WordId word_limit = 0;  ///< all word ids are below it
  int depth = 0;          ///< steps from the root to the farthest word

  const std::uint8_t* block(std::uint32_t number) const {
    return first_block + std::size_t{number} * layout.block_step;
  }
  static std::uint32_t child_count(const std::uint8_t* block) {
    std::uint16_t count = 0;
    std::memcpy(&count, block, sizeof(count));
    return count;
  }
  const std::uint8_t* descriptor(const std::uint8_t* block, std::uint32_t child) const {
    return block + layout.descriptors_offset + child * layout.descriptor_step;
  }
  Child child(const std::uint8_t* block, std::uint32_t number) const {
    Child child;
    const std::uint8_t* at = block + layout.children_offset + std::size_t{number} * 8;
    std::memcpy(&child.bits, at, 4);
    std::memcpy(&child.weight, at + 4, 4);
    return child;
  }
};

/// True if the bytes begin like an FBoW file.
bool is_fbow(std::string_view bytes);

/// Takes bytes apart that `owner` keeps; `where` stands for the file in messages. Throws InputError
/// for whatever is not a complete tree. Blocks of float descriptors must lie at multiples of 4.
std::shared_ptr<const FbowImage> parse_fbow(std::string_view bytes,
                                            std::shared_ptr<const void> owner,
                                            const std::string& where);

/// Packs a tree, which must have passed check_tree(), in the layout of the original library, with a
/// checksum behind it.
std::shared_ptr<const FbowImage> pack_tree(const VocabularyTree& tree);

/// Takes an image apart into nodes.
VocabularyTree unpack_tree(const FbowImage& image);

}  // namespace dxslam
