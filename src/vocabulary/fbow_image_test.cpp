// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "vocabulary/fbow_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <random>

#include "io/primitives/test_folder.h"
#include "vocabulary/mapped_file.h"
#include "vocabulary/test_vocabularies.h"
#include "vocabulary/vocabulary.h"

namespace dxslam {
namespace {

template <class Value>
void put(std::string& bytes, std::size_t offset, Value value) {
  std::memcpy(bytes.data() + offset, &value, sizeof(value));
}

template <class Value>
Value get(const std::string& bytes, std::size_t offset) {
  Value value;
  std::memcpy(&value, bytes.data() + offset, sizeof(value));
  return value;
}

// A file as the original library writes it, laid out by hand: 4 bytes per descriptor, k = 3. The
// root has a word (id 0, descriptor 00..) and a block (ff..); that block has the words 0 (f0..: an
// id that is there already) and 1 (0f..).
std::string foreign_file() {
  const std::size_t block = 8 + 3 * 8 + 3 * 8;
  std::string bytes(128 + 2 * block, '\0');
  put<std::uint64_t>(bytes, 0, 55824124);
  bytes.replace(8, 4, "hand");
  put<std::uint32_t>(bytes, 60, 8);           // alignment
  put<std::uint32_t>(bytes, 64, 2);           // blocks
  put<std::uint64_t>(bytes, 72, 8);           // descriptor step
  put<std::uint64_t>(bytes, 80, block);       // block step
  put<std::uint64_t>(bytes, 88, 8);           // descriptors
  put<std::uint64_t>(bytes, 96, 8 + 24);      // children
  put<std::uint64_t>(bytes, 104, 2 * block);  // total
  put<std::int32_t>(bytes, 112, 0);           // CV_8UC1
  put<std::int32_t>(bytes, 116, 4);           // bytes per descriptor
  put<std::uint32_t>(bytes, 120, 3);          // k
  const auto child = [&](std::size_t b, std::size_t i, std::uint32_t descriptor, std::uint32_t info,
                         float weight) {
    put(bytes, 128 + b * block + 8 + i * 8, descriptor);
    put(bytes, 128 + b * block + 32 + i * 8, info);
    put(bytes, 128 + b * block + 36 + i * 8, weight);
  };
  put<std::uint16_t>(bytes, 128, 2);
  put<std::uint16_t>(bytes, 130, 1);  // "leaf", though it is none: not to be relied on
  child(0, 0, 0x00000000, 0x80000000, 1.0F);
  child(0, 1, 0xffffffff, 1, 0.0F);
  put<std::uint16_t>(bytes, 128 + block, 2);
  put<std::uint16_t>(bytes, 130 + block, 1);
  put<std::uint32_t>(bytes, 132 + block, 2);
  child(1, 0, 0xfff0fff0, 0x80000000, 1.0F);
  child(1, 1, 0xffff0fff, 0x80000001, 2.0F);
  return bytes;
}

cv::Mat byte_row(std::uint32_t bits) {
  cv::Mat row(1, 4, CV_8U);
  std::memcpy(row.data, &bits, 4);
  return row;
}

TEST(FbowFile, OfTheOriginalLayoutIsRead) {
  const TestFolder folder;
  const Vocabulary vocabulary = Vocabulary::load(folder.write("v.fbow", foreign_file()));
  EXPECT_TRUE(vocabulary.binary());
  EXPECT_EQ(vocabulary.dimension(), 4);
  EXPECT_EQ(vocabulary.word_count(), 3U);
  EXPECT_EQ(vocabulary.word_limit(), 2U);
  EXPECT_THAT(vocabulary.words(byte_row(0x00000001)), testing::ElementsAre(0U));
  EXPECT_THAT(vocabulary.words(byte_row(0xffff0fff)), testing::ElementsAre(1U));
  EXPECT_THAT(vocabulary.words(byte_row(0xfff0fff0)), testing::ElementsAre(0U));
  const VocabularyInfo info = vocabulary.info();
  EXPECT_EQ(info.name, "hand");
  EXPECT_EQ(info.depth, 2);
  EXPECT_TRUE(info.mapped);
  EXPECT_FALSE(info.distinct_words);
  EXPECT_FALSE(info.has_checksum);
}

// The example of the format's description: 256 floats and k = 10.
TEST(FbowFile, HasTheSizesOfTheOriginalLibrary) {
  const auto image = pack_tree(test_tree(random_descriptors(false, 10, 256, 1), 10));
  const std::string bytes(image->file);
  EXPECT_EQ(get<std::uint64_t>(bytes, 0), 55824124U);
  EXPECT_EQ(get<std::uint32_t>(bytes, 60), 32U);
  EXPECT_EQ(get<std::uint64_t>(bytes, 72), 1024U);
  EXPECT_EQ(get<std::uint64_t>(bytes, 80), 10368U);
  EXPECT_EQ(get<std::uint64_t>(bytes, 88), 32U);
  EXPECT_EQ(get<std::uint64_t>(bytes, 96), 10272U);
  EXPECT_EQ(get<std::int32_t>(bytes, 112), 5);
  EXPECT_EQ(get<std::int32_t>(bytes, 116), 1024);
  EXPECT_EQ(get<std::uint32_t>(bytes, 120), 10U);
  EXPECT_EQ(get<std::uint16_t>(bytes, 128), 10U);
}

TEST(FbowFile, ComesBackAsItWasWritten) {
  for (const bool binary : {false, true}) {
    const TestFolder folder;
    const Vocabulary vocabulary =
        Vocabulary::from_tree(test_tree(random_descriptors(binary, 200, 33, 2)));
    vocabulary.save(folder / "v.fbow");
    const Vocabulary back = Vocabulary::load(folder / "v.fbow");
    EXPECT_TRUE(back.info().mapped);
    EXPECT_TRUE(back.info().has_checksum);
    const cv::Mat queries = random_descriptors(binary, 100, 33, 3);
    EXPECT_EQ(back.transform(queries).words, vocabulary.transform(queries).words);
    back.save(folder / "again.fbow");
    EXPECT_EQ(folder.read("again.fbow"), folder.read("v.fbow"));
    Vocabulary::from_tree(back.tree()).save(folder / "rebuilt.fbow");
    EXPECT_EQ(folder.read("rebuilt.fbow"), folder.read("v.fbow"));
  }
}

TEST(FbowFile, OutlivesItsReplacement) {
  const TestFolder folder;
  const auto save = [&](unsigned seed) {
    Vocabulary::from_tree(test_tree(random_descriptors(true, 50, 32, seed)))
        .save(folder / "v.fbow");
  };
  save(4);
  const Vocabulary vocabulary = Vocabulary::load(folder / "v.fbow");
  const cv::Mat queries = random_descriptors(true, 40, 32, 6);
  const std::vector<WordId> before = vocabulary.words(queries);
  save(5);
  EXPECT_EQ(vocabulary.words(queries), before);
}

struct Damage {
  const char* name;
  std::function<void(std::string&)> change;
  const char* says;
};

class HostileFbowTest : public testing::TestWithParam<Damage> {};

TEST_P(HostileFbowTest, IsRefusedInOneSentence) {
  const TestFolder folder;
  std::string bytes = foreign_file();
  GetParam().change(bytes);
  const std::string path = folder.write("v.fbow", bytes);
  expect_input_error([&] { Vocabulary::load(path); }, {path, GetParam().says});
}

constexpr std::size_t kRoot = 128;
constexpr std::size_t kSecond = 128 + 56;

INSTANTIATE_TEST_SUITE_P(
    Damages, HostileFbowTest,
    testing::Values(
        Damage{"CutHeader", [](std::string& b) { b.resize(100); }, "has 100 bytes"},
        Damage{"CutBlocks", [](std::string& b) { b.pop_back(); }, "111 bytes follow its header"},
        Damage{"Longer", [](std::string& b) { b += "xyz"; }, "3 bytes behind its 2 blocks"},
        Damage{"WrongChecksum",
               [](std::string& b) {
                 b += "DXLSUM02";
                 b += "12345678";
               },
               "checksum"},
        Damage{"OtherType", [](std::string& b) { put<std::int32_t>(b, 112, 6); }, "type 6"},
        Damage{"NoBlocks", [](std::string& b) { put<std::uint32_t>(b, 64, 0); }, "0 blocks"},
        Damage{"ManyBlocks", [](std::string& b) { put<std::uint32_t>(b, 64, 0xffffffffU); },
               "4294967295 blocks"},
        Damage{"Overflow",
               [](std::string& b) {
                 put<std::uint32_t>(b, 64, 0x80000000U);
                 put<std::uint64_t>(b, 80, 0x200000000U);
                 put<std::uint64_t>(b, 104, 0U);
               },
               "2147483648 blocks"},
        Damage{"HugeBranching", [](std::string& b) { put<std::uint32_t>(b, 120, 70000); },
               "branching factor of 70000"},
        Damage{"NoBranching", [](std::string& b) { put<std::uint32_t>(b, 120, 0); },
               "branching factor of 0"},
        Damage{"MoreBranchingThanFits", [](std::string& b) { put<std::uint32_t>(b, 120, 4); },
               "does not fit"},
        Damage{"NegativeDescriptor", [](std::string& b) { put<std::int32_t>(b, 116, -4); },
               "descriptors of"},
        Damage{"DescriptorBeyondStep", [](std::string& b) { put<std::int32_t>(b, 116, 9); },
               "does not fit"},
        Damage{"StepOverflows",
               [](std::string& b) { put<std::uint64_t>(b, 72, 0x8000000000000000U); },
               "does not fit"},
        Damage{"ChildrenBeyondBlock", [](std::string& b) { put<std::uint64_t>(b, 96, 40); },
               "does not fit"},
        Damage{"ChildrenFarBeyond",
               [](std::string& b) {
                 put<std::uint64_t>(b, 96, std::numeric_limits<std::uint64_t>::max() - 8);
               },
               "does not fit"},
        Damage{"DescriptorsOverCount", [](std::string& b) { put<std::uint64_t>(b, 88, 0); },
               "does not fit"},
        Damage{"FloatsNotAligned",
               [](std::string& b) {
                 put<std::int32_t>(b, 112, 5);
                 put<std::uint64_t>(b, 72, 6);
               },
               "multiples of 4"},
        Damage{"NoChildren", [](std::string& b) { put<std::uint16_t>(b, kSecond, 0); },
               "block 1 has 0 children"},
        Damage{"TooManyChildren", [](std::string& b) { put<std::uint16_t>(b, kRoot, 4); },
               "block 0 has 4 children"},
        Damage{"ChildOutside", [](std::string& b) { put<std::uint32_t>(b, kRoot + 40, 2); },
               "has block 2 as a child"},
        Damage{"RootAsChild", [](std::string& b) { put<std::uint32_t>(b, kRoot + 40, 0); },
               "has block 0 as a child"},
        Damage{"Circle", [](std::string& b) { put<std::uint32_t>(b, kSecond + 32, 1); },
               "block 1 has block 1 as a child"},
        Damage{"Unreachable",
               [](std::string& b) { put<std::uint32_t>(b, kRoot + 40, 0x80000001U); },
               "only 1 of its 2 blocks"},
        Damage{"WordIdTooLarge",
               [](std::string& b) { put<std::uint32_t>(b, kRoot + 32, 0xffffffffU); },
               "id 2147483647"},
        Damage{"NotANumber",
               [](std::string& b) { put(b, kRoot + 36, std::numeric_limits<float>::quiet_NaN()); },
               "weight"},
        Damage{"NegativeWeight", [](std::string& b) { put(b, kRoot + 36, -1.0F); }, "weight -1"}),
    [](const testing::TestParamInfo<Damage>& param) { return param.param.name; });

TEST(FbowFile, ThatIsMissingOrEmptyOrAFolderIsRefused) {
  const TestFolder folder;
  expect_input_error([&] { Vocabulary::load(folder / "none"); }, {"none", "expected a vocabulary"});
  expect_input_error([&] { Vocabulary::load(folder.path()); }, {"not a regular file"});
  const std::string empty = folder.write("empty", std::string());
  expect_input_error([&] { Vocabulary::load(empty); }, {"is empty", "expected a vocabulary"});
  const std::string other = folder.write("picture.png", std::string("\x89PNG\r\n\x1a\n"));
  expect_input_error([&] { Vocabulary::load(other); }, {"expected a vocabulary"});
}

// Whatever the bytes, a file is refused or gives words: no read beyond the end (sanitizer builds
// see it) and no endless descent.
TEST(FbowFile, SurvivesRandomDamage) {
  std::mt19937 random(17);
  const std::string own(pack_tree(test_tree(random_descriptors(false, 40, 8, 7), 3))->file);
  const std::string without_sum = own.substr(0, own.size() - 16);
  int accepted = 0;
  for (int round = 0; round < 4000; ++round) {
    std::string bytes = round % 2 == 0 ? foreign_file() : without_sum;
    const std::size_t header = round % 3 == 0 ? 128 : bytes.size();
    for (int n = std::uniform_int_distribution<int>(1, 4)(random); n > 0; --n) {
      const auto at = std::uniform_int_distribution<std::size_t>(8, header - 1)(random);
      bytes[at] = static_cast<char>(std::uniform_int_distribution<int>(0, 255)(random));
    }
    if (round % 7 == 0) bytes.resize(1 + random() % bytes.size());
    // A copy of exactly this size on the heap, so that reading on is noticed.
    const auto owner = std::make_shared<std::vector<float>>((bytes.size() + 3) / 4);
    std::memcpy(owner->data(), bytes.data(), bytes.size());
    const std::string_view view(reinterpret_cast<const char*>(owner->data()), bytes.size());
    try {
      const auto image = parse_fbow(view, owner, "fuzz");
      const Vocabulary vocabulary = Vocabulary::from_tree(unpack_tree(*image));
      const auto dimension = static_cast<int>(image->layout.dimension());
      vocabulary.transform(random_descriptors(image->layout.binary, 9, dimension, 8));
      ++accepted;
    } catch (const InputError&) {
    } catch (const ContractError&) {  // from_tree: ids of foreign files may exceed the words
    }
  }
  EXPECT_GT(accepted, 100);  // damage to descriptors is no damage to the tree
}

}  // namespace
}  // namespace dxslam
