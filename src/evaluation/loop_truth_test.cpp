// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "evaluation/loop_truth.h"

#include <sys/stat.h>
#include <zlib.h>

#include <cstdint>
#include <map>
#include <random>

#include "evaluation/mat_file.h"
#include "io/primitives/test_folder.h"

namespace dxslam {
namespace {

std::string word(std::uint32_t value) { return {reinterpret_cast<const char*>(&value), 4}; }

std::string element(std::uint32_t type, const std::string& data) {
  return word(type) + word(static_cast<std::uint32_t>(data.size())) + data +
         std::string((8 - data.size() % 8) % 8, '\0');
}

std::string header() {
  std::string text = "MATLAB 5.0 MAT-file, made by a test";
  text.resize(124, ' ');
  return text + std::string("\x00\x01IM", 4);
}

std::string array_start(std::uint32_t array_class, std::uint32_t rows, std::uint32_t columns,
                        std::uint32_t stored = 0) {
  const std::string name(
      "\x01\x00\x02\x00"
      "ab\x00\x00",
      8);  // in the tag itself
  return element(6, word(array_class) + word(stored)) + element(5, word(rows) + word(columns)) +
         name;
}

std::string compressed(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string out(size, '\0');
  compress(reinterpret_cast<Bytef*>(out.data()), &size,
           reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()));
  out.resize(size);
  return word(15) + word(static_cast<std::uint32_t>(size)) + out;
}

// 3 x 3, column by column: frame 2 is back at frame 0.
std::string dense_matrix() {
  return element(14, array_start(9, 3, 3) +
                         element(2, std::string("\x00\x00\x01\x00\x00\x00\x00\x00\x00", 9)));
}

using Entries = std::map<std::pair<std::size_t, std::size_t>, double>;

Entries entries_of(const std::string& path) {
  Entries entries;
  read_mat(
      path, [](const MatShape&) {},
      [&](std::size_t row, std::size_t column, double value) { entries[{row, column}] = value; });
  return entries;
}

TEST(MatFile, ReadsDenseMatricesPlainAndCompressed) {
  const TestFolder folder;
  const Entries expected = {{{2, 0}, 1.0}};
  EXPECT_EQ(entries_of(folder.write("plain.mat", header() + dense_matrix())), expected);
  EXPECT_EQ(entries_of(folder.write("packed.mat", header() + compressed(dense_matrix()))),
            expected);
}

TEST(MatFile, ReadsSparseMatrices) {
  const TestFolder folder;
  const double values[] = {4.5, -2.0};
  const std::string matrix = element(
      14, array_start(5, 3, 3, 2) + element(5, word(2) + word(1)) +
              element(5, word(0) + word(1) + word(1) + word(2)) +
              element(9, std::string(reinterpret_cast<const char*>(values), sizeof(values))));
  const Entries expected = {{{2, 0}, 4.5}, {{1, 2}, -2.0}};
  EXPECT_EQ(entries_of(folder.write("sparse.mat", header() + matrix)), expected);
}

TEST(MatFile, TakesTheLargestOfSeveralMatrices) {
  const TestFolder folder;
  const std::string scalar = element(14, array_start(9, 1, 1) + element(2, "\x07"));
  const std::string path = folder.write("two.mat", header() + scalar + dense_matrix() + scalar);
  EXPECT_EQ(entries_of(path).size(), 1U);
}

TEST(MatFile, RefusesFilesCutAnywhere) {
  const TestFolder folder;
  for (const std::string& whole :
       {header() + dense_matrix(), header() + compressed(dense_matrix())}) {
    for (std::size_t size = 100; size < whole.size(); ++size) {
      const std::string path = folder.write("cut.mat", whole.substr(0, size));
      // Only the padding behind the last element may be missing.
      if (whole == header() + dense_matrix() && size + 7 >= whole.size()) continue;
      EXPECT_THROW(entries_of(path), InputError) << size << " bytes";
    }
  }
}

TEST(MatFile, RefusesEntriesBeyondTheMatrix) {
  const TestFolder folder;
  const std::string row_outside = element(
      14, array_start(5, 3, 3, 1) + element(5, word(3)) +
              element(5, word(0) + word(1) + word(1) + word(1)) + element(9, std::string(8, '\1')));
  expect_input_error([&] { entries_of(folder.write("a.mat", header() + row_outside)); },
                     {"a.mat", "damaged"});
  const std::string falling_starts = element(
      14, array_start(5, 3, 3, 1) + element(5, word(0)) +
              element(5, word(0) + word(9) + word(0) + word(1)) + element(9, std::string(8, '\1')));
  expect_input_error([&] { entries_of(folder.write("b.mat", header() + falling_starts)); },
                     {"b.mat", "damaged"});
}

// Whatever the bytes say, a small file costs little (libmatio takes gigabytes for some of these).
TEST(MatFile, SurvivesRandomDamage) {
  const TestFolder folder;
  const double values[] = {4.5, -2.0};
  const std::string sparse = element(
      14, array_start(5, 3, 3, 2) + element(5, word(2) + word(1)) +
              element(5, word(0) + word(1) + word(1) + word(2)) +
              element(9, std::string(reinterpret_cast<const char*>(values), sizeof(values))));
  const std::uint32_t words[] = {0,  1,  2,         3,       5,          9,          14,
                                 15, 64, 1U << 16U, 1000000, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF};
  std::mt19937 random(5);
  int refused = 0;
  for (int i = 0; i < 4000; ++i) {
    std::string matrix = random() % 2 == 0 ? sparse : dense_matrix();
    for (unsigned k = 1 + random() % 3; k > 0; --k) {
      if (random() % 2 == 0) {
        matrix[random() % matrix.size()] = static_cast<char>(random());
      } else {
        matrix.replace(random() % (matrix.size() / 4) * 4, 4, word(words[random() % 14]));
      }
    }
    if (random() % 2 == 0) matrix = compressed(matrix);
    try {
      entries_of(folder.write("m.mat", header() + matrix));
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
}

TEST(MatFile, SaysWhatIsWrongWithOtherVersions) {
  const TestFolder folder;
  expect_input_error(
      [&] { entries_of(folder.write("h5.mat", "MATLAB 7.3 MAT-file" + std::string(200, ' '))); },
      {"h5.mat", "7.3", "-v7"});
  std::string big_endian = header();
  big_endian.replace(124, 4, std::string("\x01\x00MI", 4));
  expect_input_error([&] { entries_of(folder.write("big.mat", big_endian)); }, {"big-endian"});
}

TEST(LoopTruth, IsTheSameInBothOrders) {
  LoopTruth truth(4);
  truth.set(1, 3, PairTruth::kSame);
  truth.set(2, 0, PairTruth::kUnclear);
  EXPECT_EQ(truth.at(3, 1), PairTruth::kSame);
  EXPECT_EQ(truth.at(0, 2), PairTruth::kUnclear);
  EXPECT_EQ(truth.at(0, 1), PairTruth::kDifferent);
  truth.set(0, 2, PairTruth::kSame);
  EXPECT_EQ(truth.at(0, 2), PairTruth::kSame);
  EXPECT_THROW(truth.at(2, 2), ContractError);
  EXPECT_THROW(truth.at(0, 4), ContractError);
}

// A BMP of one bit a pixel, as MATLAB writes masks; rows of four bytes from the bottom up.
std::string black_and_white_bmp() {
  std::string bytes = "BM" + word(74) + word(0) + word(62) + word(40) + word(3) + word(3);
  bytes += word(1 | 1 << 16);  // one plane, one bit
  for (const std::uint32_t value : {0U, 12U, 0U, 0U, 2U, 0U, 0U, 0xFFFFFFU}) bytes += word(value);
  return bytes + word(0x80) + word(0) + word(0);
}

TEST(LoopTruth, ReadsMatFilesTextAndImagesAlike) {
  const TestFolder folder;
  cv::Mat picture(3, 3, CV_8UC1, cv::Scalar(0));
  picture.at<std::uint8_t>(2, 0) = 255;
  for (const std::string& path :
       {folder.write("truth.mat", header() + dense_matrix()),
        folder.write("truth.txt", "0 0 0\n0,1,0\n1\t0 0\n"), folder.write("truth.png", picture),
        folder.write("truth.bmp", black_and_white_bmp())}) {
    const LoopTruth truth = read_loop_truth(path);
    ASSERT_EQ(truth.frames(), 3U) << path;
    EXPECT_EQ(truth.at(0, 2), PairTruth::kSame) << path;
    EXPECT_EQ(truth.at(0, 1), PairTruth::kDifferent) << path;
  }
}

TEST(LoopTruth, RefusesWhatIsNoSquareMatrixOfLoops) {
  const TestFolder folder;
  expect_input_error([&] { read_loop_truth(folder.write("flat.txt", "0 1 0\n1 0 0\n")); },
                     {"flat.txt", "2 x 3"});
  expect_input_error([&] { read_loop_truth(folder.write("ragged.txt", "0 1\n1\n")); },
                     {"ragged.txt:2", "1 columns"});
  expect_input_error([&] { read_loop_truth(folder.write("words.txt", "0 no\n1 0\n")); },
                     {"words.txt:1", "'no'"});
  expect_input_error([&] { read_loop_truth(folder.write("none.txt", "0 0\n0 0\n")); },
                     {"none.txt", "no true loop"});
  expect_input_error([&] { read_loop_truth(folder / "absent.txt"); }, {"absent.txt", "no such"});
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);  // which nobody writes to
  expect_input_error([&] { read_loop_truth(folder / "pipe"); }, {"pipe", "not a regular file"});
}

TEST(LoopTruth, TakesOneCameraOfSeveral) {
  LoopTruth truth(7);
  truth.set(5, 1, PairTruth::kSame);
  truth.set(6, 1, PairTruth::kSame);
  const LoopTruth right = every_nth(truth, 1, 2);  // 1 3 5
  EXPECT_EQ(right.frames(), 3U);
  EXPECT_EQ(right.at(2, 0), PairTruth::kSame);
  EXPECT_EQ(right.at(1, 0), PairTruth::kDifferent);
  EXPECT_EQ(every_nth(truth, 0, 2).frames(), 4U);
}

struct RealMatrix {
  const char* file;
  std::size_t frames;
  std::size_t loops;  // counted by another reader (SciPy)
};

TEST(LoopTruth, ReadsTheMatricesOfTheField) {
  const std::string folder = shared_data("lcd_groundtruth");
  if (folder.empty()) GTEST_SKIP() << "the shared ground-truth matrices are absent";
  for (const RealMatrix& real : {RealMatrix{"NewCollegeGroundTruth.mat", 2146, 14832},
                                 RealMatrix{"city_GT_final.mat", 1237, 8321},
                                 RealMatrix{"Lip6IndoorGroundTruth.mat", 388, 884},
                                 RealMatrix{"newcollege_GT.mat", 2624, 46753},
                                 RealMatrix{"kitti06GroundTruth.mat", 1101, 3287},
                                 RealMatrix{"groundTruth_KITTI_05.mat", 2761, 10558}}) {
    const LoopTruth truth = read_loop_truth(folder + "/GT/" + real.file);
    ASSERT_EQ(truth.frames(), real.frames) << real.file;
    std::size_t loops = 0;
    for (std::size_t i = 0; i < truth.frames(); ++i) {
      for (std::size_t j = 0; j < i; ++j) loops += truth.at(i, j) == PairTruth::kSame ? 1U : 0U;
    }
    EXPECT_EQ(loops, real.loops) << real.file;
  }
}

}  // namespace
}  // namespace dxslam
