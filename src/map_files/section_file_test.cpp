// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map_files/section_file.h"

#include "io/primitives/test_folder.h"

namespace dxslam {
namespace {

std::string two_sections() {
  SectionWriter writer(100);
  writer.begin("AAAA", 1, true);
  writer.put(std::uint32_t{7});
  writer.put_text("text");
  writer.begin("BBBB", 3, false);
  return writer.finish();
}

TEST(SectionFile, GivesBackWhatWasPutIn) {
  const std::string file = two_sections();
  const std::vector<Section> sections = read_sections(file, "f");
  ASSERT_EQ(sections.size(), 2U);
  EXPECT_EQ(sections[1].id, "BBBB");
  EXPECT_EQ(sections[1].version, 3U);
  EXPECT_TRUE(sections[0].required);
  EXPECT_FALSE(sections[1].required);
  EXPECT_TRUE(sections[1].bytes.empty());
  SectionReader reader(sections[0], "f");
  EXPECT_EQ(reader.get<std::uint32_t>(), 7U);
  EXPECT_EQ(reader.get_text(), "text");
  reader.expect_end();
}

TEST(SectionFile, ReaderStopsAtTheEnd) {
  const std::string bytes("\x05\0\0\0\x01\0\0\0", 8);
  const auto reader = [&] { return SectionReader({"AAAA", 1, true, bytes}, "f.dxmap"); };
  expect_input_error([&] { reader().take(3, 4); }, {"f.dxmap: damaged map file: section AAAA"});
  expect_input_error([&] { reader().take(~std::size_t{0}, ~std::size_t{0}); }, {"ends before"});
  expect_input_error([&] { reader().get_count(1); }, {"5 records do not fit"});
  expect_input_error([&] { reader().get_text(); }, {"ends before"});
  expect_input_error([&] { reader().expect_end(); }, {"8 bytes too many"});
  SectionReader text({"AAAA", 1, true, std::string_view("\x01\0\0\0\x1B", 5)}, "f");
  expect_input_error([&] { text.get_text(); }, {"control characters"});
}

TEST(SectionFile, RefusesWhatIsNoMapFile) {
  expect_input_error([] { read_sections("", "f"); }, {"f: is no dxslam map"});
  expect_input_error([] { read_sections("ply\nformat binary", "f"); }, {"is no dxslam map"});
  expect_input_error([] { read_sections(two_sections().substr(0, 5), "f"); }, {"cut short"});
}

TEST(SectionFile, RefusesFilesThatAreNotWhole) {
  const std::string file = two_sections();
  for (std::size_t size = 0; size < file.size(); ++size) {
    EXPECT_THROW(read_sections(std::string_view(file).substr(0, size), "f"), InputError);
  }
  expect_input_error([&] { read_sections(file + "x", "f"); }, {"expected"});
  for (std::size_t bit = 0; bit < 8 * file.size(); ++bit) {
    std::string altered = file;
    altered[bit / 8] = static_cast<char>(altered[bit / 8] ^ (1 << bit % 8));
    EXPECT_THROW(read_sections(altered, "f"), InputError) << "bit " << bit;
  }
}

}  // namespace
}  // namespace dxslam
