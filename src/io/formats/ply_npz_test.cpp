// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors

// Files for other programs: PLY and NumPy archives, read back by the definition of the format and,
// where the evaluation environment has it, by NumPy itself.
#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "io/formats/npz_writer.h"
#include "io/formats/ply_file.h"
#include "io/primitives/test_folder.h"

namespace dxslam {
namespace {

TEST(PlyFile, HoldsPointsThenKeyframesAndTheirEdges) {
  const TestFolder folder;
  const double nan = std::nan("");
  write_ply(folder / "m.ply", {{{1, 2, 3}, {10, 20, 30}}, {{nan, 0, 0}, {}}, {{4, 5, 6}, {}}},
            {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  const std::string bytes = folder.read("m.ply");
  EXPECT_THAT(bytes, testing::StartsWith("ply\nformat binary_little_endian 1.0\n"));
  EXPECT_THAT(bytes, testing::HasSubstr("element vertex 5\n"));
  EXPECT_THAT(bytes, testing::HasSubstr("element edge 2\n"));
  const std::size_t body = bytes.find("end_header\n") + 11;
  ASSERT_EQ(bytes.size() - body, 5U * 15U + 2U * 8U);
  float position[3];
  std::memcpy(position, &bytes[body], sizeof position);
  EXPECT_EQ(position[2], 3.0F);
  EXPECT_EQ(bytes[body + 12], 10);
  std::int32_t edge[2];
  std::memcpy(edge, &bytes[body + 5 * 15 + 8], sizeof edge);
  EXPECT_EQ(edge[0], 3);
  EXPECT_EQ(edge[1], 4);
}

TEST(PlyFile, ScoreColoursRiseInLightness) {
  double last = -1.0;
  for (double score = 0.0; score <= 1.0; score += 0.05) {
    const Rgb c = color_of_score(score);
    const double lightness = 0.299 * c[0] + 0.587 * c[1] + 0.114 * c[2];
    EXPECT_GT(lightness, last);
    last = lightness;
  }
  EXPECT_EQ(color_of_score(std::nan("")), color_of_score(0.0));
  EXPECT_EQ(color_of_score(7.0), color_of_score(1.0));
}

TEST(NpzWriter, IsReadByNumpy) {
  const TestFolder folder;
  NpzWriter writer;
  writer.add("keypoints", {2, 2}, std::vector<float>{1.5F, 2, 3, 4});
  writer.add("bytes", {3}, std::vector<std::uint8_t>{1, 2, 255});
  writer.add("ids", {2, 1}, std::vector<std::int32_t>{-5, 6});
  writer.add("scale", {}, std::vector<double>{0.25});
  writer.add("none", {0, 64}, std::vector<float>{});
  const cv::Mat matrix = (cv::Mat_<float>(2, 3) << 1, 2, 3, 4, 5, 6);
  writer.add("part", matrix.colRange(1, 3));
  writer.write(folder / "a.npz");
  writer.write(folder / "b.npz");
  EXPECT_EQ(folder.read("a.npz"), folder.read("b.npz")) << "not deterministic";
  const std::string python = DXSLAM_SOURCE_DIR "/.venvs/eval/bin/python";
  if (!std::filesystem::exists(python)) {
    GTEST_SKIP() << python << " is missing; scripts/setup installs it";
  }
  folder.write("check.py", R"(
import sys, zipfile, numpy as np
assert zipfile.ZipFile(sys.argv[1]).testzip() is None
a = np.load(sys.argv[1])
assert sorted(a.files) == ['bytes', 'ids', 'keypoints', 'none', 'part', 'scale'], a.files
assert a['keypoints'].dtype == np.float32 and a['keypoints'].tolist() == [[1.5, 2], [3, 4]]
assert a['bytes'].dtype == np.uint8 and a['bytes'].tolist() == [1, 2, 255]
assert a['ids'].dtype == np.int32 and a['ids'].tolist() == [[-5], [6]]
assert a['scale'].shape == () and float(a['scale']) == 0.25
assert a['none'].shape == (0, 64)
assert a['part'].tolist() == [[2, 3], [5, 6]]
)");
  const std::string command =
      fmt::format("'{}' '{}' '{}'", python, folder / "check.py", folder / "a.npz");
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST(NpzWriter, RefusesArraysThatDoNotFit) {
  NpzWriter writer;
  EXPECT_THROW(writer.add("a", {3}, std::vector<float>{1}), ContractError);
  writer.add("a", {1}, std::vector<float>{1});
  EXPECT_THROW(writer.add("a", {1}, std::vector<float>{1}), ContractError);
  EXPECT_THROW(writer.add("b/c", {1}, std::vector<float>{1}), ContractError);
  EXPECT_THROW(writer.add("m", cv::Mat(2, 2, CV_8UC3)), ContractError);
}

}  // namespace
}  // namespace dxslam
