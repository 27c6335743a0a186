// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "vocabulary/vocabulary.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/error.h"
#include "io/primitives/atomic_file.h"
#include "vocabulary/dbow2_text.h"
#include "vocabulary/fbow_image.h"
#include "vocabulary/mapped_file.h"
#include "vocabulary/vocabulary_tree.h"
#include "vocabulary/word_search.h"

namespace dxslam {
namespace {

// Calls visit(child) for each child of each block.
template <class Visitor>
void visit_children(const FbowImage& image, const Visitor& visit) {
  for (std::uint32_t b = 0; b < image.layout.blocks; ++b) {
    const std::uint8_t* block = image.block(b);
    for (std::uint32_t i = 0; i < FbowImage::child_count(block); ++i) visit(image.child(block, i));
  }
}

std::vector<FbowImage::Child> search(const Vocabulary& vocabulary, const FbowImage& image,
                                     const cv::Mat& descriptors) {
  require(vocabulary.fits(descriptors),
          "descriptors must be of the vocabulary's kind and dimension");
  std::vector<FbowImage::Child> found(static_cast<std::size_t>(descriptors.rows));
  search_words(image, descriptors, found.data());
  return found;
}

}  // namespace

Vocabulary::Vocabulary(std::shared_ptr<const FbowImage> image) : image_(std::move(image)) {}

Vocabulary Vocabulary::load(const std::string& path) {
  const auto file = std::make_shared<MappedFile>(path, "a vocabulary (FBoW or DBoW2 text)");
  const std::string_view bytes(reinterpret_cast<const char*>(file->data()), file->size());
  if (!is_fbow(bytes)) return from_tree(parse_dbow2_text(bytes, path));
  const auto image = std::make_shared<FbowImage>(*parse_fbow(bytes, file, path));
  image->mapped = true;
  return Vocabulary(image);
}

Vocabulary Vocabulary::from_tree(const VocabularyTree& tree) {
  check_tree(tree);
  return Vocabulary(pack_tree(tree));
}

void Vocabulary::require_target(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_regular_file(path, error)) {
    const MappedFile file(path, "a vocabulary or a new name");
    const std::string_view bytes(reinterpret_cast<const char*>(file.data()), file.size());
    // An empty file is what mktemp makes.
    if (!bytes.empty() && !is_fbow(bytes) && !is_dbow2_text(bytes)) {
      throw InputError(fmt::format(
          "{}: is no vocabulary and is not replaced, expected a vocabulary or a new name", path));
    }
  }
  require_writable(path);
}

void Vocabulary::save(const std::string& path) const { write_file_atomically(path, image_->file); }

VocabularyTree Vocabulary::tree() const { return unpack_tree(*image_); }

bool Vocabulary::fits(const cv::Mat& descriptors) const {
  if (descriptors.rows == 0) return true;
  return descriptors.type() == (binary() ? CV_8U : CV_32F) && descriptors.cols == dimension();
}

std::vector<WordId> Vocabulary::words(const cv::Mat& descriptors) const {
  std::vector<WordId> words;
  for (const FbowImage::Child& leaf : search(*this, *image_, descriptors)) {
    words.push_back(leaf.index());
  }
  return words;
}

BowVector Vocabulary::transform(const cv::Mat& descriptors) const {
  std::vector<std::pair<WordId, float>> entries;
  for (const FbowImage::Child& leaf : search(*this, *image_, descriptors)) {
    entries.emplace_back(leaf.index(), leaf.weight);
  }
  return make_bow_vector(std::move(entries));
}

const std::string& Vocabulary::name() const { return image_->layout.name; }
std::size_t Vocabulary::word_count() const { return image_->words; }
WordId Vocabulary::word_limit() const { return image_->word_limit; }
bool Vocabulary::binary() const { return image_->layout.binary; }
int Vocabulary::dimension() const { return static_cast<int>(image_->layout.dimension()); }
int Vocabulary::descriptor_bytes() const {
  return static_cast<int>(image_->layout.descriptor_bytes);
}

VocabularyInfo Vocabulary::info() const {
  VocabularyInfo info;
  info.name = image_->layout.name;
  info.binary = binary();
  info.dimension = dimension();
  info.branching = static_cast<int>(image_->layout.branching);
  info.depth = image_->depth;
  info.words = image_->words;
  info.inner_nodes = image_->layout.blocks;
  info.bytes = image_->file.size();
  info.mapped = image_->mapped;
  info.has_checksum = image_->has_checksum;
  std::vector<char> seen(image_->word_limit, 0);
  bool first = true;
  visit_children(*image_, [&](const FbowImage::Child& child) {
    if (!child.is_word()) return;
    if (seen[child.index()]) info.distinct_words = false;
    seen[child.index()] = 1;
    info.min_weight = first ? child.weight : std::min(info.min_weight, child.weight);
    info.max_weight = first ? child.weight : std::max(info.max_weight, child.weight);
    first = false;
  });
  return info;
}

std::string trained_name(const std::string& features, const std::string& method) {
  return features + " " + method;
}

namespace {

// What the name says that it was trained on; empty where it says nothing.
std::string features_in_name(const std::string& name) {
  for (const char* method : {"incremental", "kmeans"}) {
    const std::string ending = trained_name("", method);
    if (name.ends_with(ending)) return name.substr(0, name.size() - ending.size());
  }
  return {};
}

// Two that detect otherwise and describe alike.
std::string descriptors_of(const std::string& features) {
  return features == "opencv_orb" ? "orb" : features;
}

}  // namespace

void require_words_of(const Vocabulary& vocabulary, const std::string& path,
                      const std::string& features, bool binary, int dimension) {
  const auto kind = [](bool of_bytes) { return of_bytes ? "bytes" : "floats"; };
  if (vocabulary.binary() != binary || vocabulary.dimension() != dimension) {
    throw InputError(fmt::format(
        "{}: is a vocabulary of {} {} per descriptor, expected {} {} as `{}` has them", path,
        vocabulary.dimension(), kind(vocabulary.binary()), dimension, kind(binary), features));
  }
  const std::string trained_on = features_in_name(vocabulary.name());
  if (trained_on.empty() || descriptors_of(trained_on) == descriptors_of(features)) return;
  throw InputError(fmt::format("{}: was trained on features `{}`, expected a vocabulary of `{}`",
                               path, trained_on, features));
}

}  // namespace dxslam
