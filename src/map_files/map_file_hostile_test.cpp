// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors

// Files that were cut, altered, or made to do harm: thousands of them, none of which may do
// anything but load as a sound map or be refused in one sentence.
#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <random>

#include "io/primitives/test_folder.h"
#include "map_files/crc32c.h"
#include "map_files/map_limits.h"
#include "map_files/map_merge.h"
#include "map_files/map_sections.h"
#include "map_files/map_statistics.h"
#include "map_files/section_file.h"
#include "map_files/test_map_files.h"

namespace dxslam {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // the sanitizers reserve terabytes of addresses
#else
constexpr bool kSanitized = false;
#endif

// Makes memory run out soon after what the process has now, so that a file that asks for much more
// than it holds is noticed.
class MemoryLimit {
 public:
  explicit MemoryLimit(std::size_t spare) {
    if (kSanitized) return;
    ::getrlimit(RLIMIT_AS, &before_);
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlimit limit{pages * 4096 + spare, before_.rlim_max};
    ::setrlimit(RLIMIT_AS, &limit);
  }
  ~MemoryLimit() {
    if (!kSanitized) ::setrlimit(RLIMIT_AS, &before_);
  }

 private:
  rlimit before_{};
};

std::string bytes_of(const MapSnapshot& snapshot, bool exact = false) {
  const TestFolder folder;
  save_map(folder / "m", snapshot, {exact});
  return folder.read("m");
}

// The layout of the file, stated once more: header (sections at 12, checksum of the table at 24, of
// the header at 28), sections, table of 32 bytes per entry (offset at 8, size at 16, checksum at
// 24).
template <class Value>
Value peek(const std::string& file, std::size_t at) {
  Value value;
  std::memcpy(&value, &file.at(at), sizeof value);
  return value;
}
template <class Value>
void poke(std::string& file, std::size_t at, Value value) {
  std::memcpy(&file.at(at), &value, sizeof value);
}
std::size_t table_of(const std::string& file) {
  return file.size() - 32 * peek<std::uint32_t>(file, 12);
}

// Makes all checksums right again, as somebody would who means harm.
void sign(std::string& file) {
  const std::size_t table = table_of(file);
  for (std::size_t entry = table; entry < file.size(); entry += 32) {
    const auto offset = peek<std::uint64_t>(file, entry + 8);
    const auto size = peek<std::uint64_t>(file, entry + 16);
    if (offset > file.size() || size > file.size() - offset) continue;
    poke(file, entry + 24, crc32c(file.data() + offset, size));
  }
  poke(file, 24, crc32c(file.data() + table, file.size() - table));
  poke(file, 28, crc32c(file.data(), 28));
}

// Whether it was loaded; all that a program does with a map must then work. Anything thrown but an
// InputError fails the test.
bool survives(const std::string& file) {
  try {
    const StoredMap stored = parse_map(file.data(), file.size(), "f");
    map_statistics(stored);
    merge_maps(stored, "a", stored, "b");
    return true;
  } catch (const InputError& e) {
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
    EXPECT_EQ(std::string(e.what()).rfind("f: ", 0), 0U) << e.what();
    return false;
  }
}

TEST(HostileMapFile, CutAnywhereIsRefused) {
  const std::string file = bytes_of(sample_snapshot(4, false, 20));
  for (std::size_t size = 0; size < file.size(); ++size) {
    ASSERT_FALSE(survives(file.substr(0, size))) << size << " of " << file.size();
  }
}

TEST(HostileMapFile, WithAnyAlteredByteIsRefused) {
  std::mt19937 random(5);
  const std::string file = bytes_of(sample_snapshot(4, false, 20));
  for (std::size_t at = 0; at < file.size(); ++at) {
    std::string altered = file;
    altered[at] = static_cast<char>(altered[at] ^ (1 + random() % 255));
    ASSERT_FALSE(survives(altered)) << "byte " << at;
  }
}

TEST(HostileMapFile, WithExchangedPartsIsRefused) {
  std::mt19937 random(6);
  const std::string file = bytes_of(sample_snapshot(4, false, 20));
  const std::string other = bytes_of(sample_snapshot(5, false, 20));
  for (int i = 0; i < 500; ++i) {
    std::string altered = file;
    const std::size_t from = random() % file.size();
    const std::size_t length = 1 + random() % (file.size() - from);
    altered.replace(from, length, other, random() % other.size(), random() % length);
    ASSERT_FALSE(altered != file && survives(altered));
  }
}

// Values that hurt where they are taken for counts, ids, sizes or numbers.
std::uint64_t nasty_value(std::mt19937& random) {
  static constexpr std::uint64_t kValues[] = {0,
                                              1,
                                              2,
                                              5,
                                              0x7FFFFFFF,
                                              0x80000000,
                                              0xFFFFFFFF,
                                              0xFFFFFFFE,
                                              0x00010000,
                                              0x10000000,
                                              0x7FFFFFFFFFFFFFFF,
                                              0xFFFFFFFFFFFFFFFF,
                                              0x7FF0000000000000,  // infinity
                                              0x7FF8000000000001,  // not a number
                                              0x7F8000007F800000,  // two of float
                                              0x7FC000017FC00001};
  return random() % 3 == 0 ? (std::uint64_t{random()} << 32 | random())
                           : kValues[random() % std::size(kValues)];
}

void spoil(std::string& file, std::size_t begin, std::size_t end, std::mt19937& random) {
  for (std::size_t edits = 1 + random() % 3; edits > 0; --edits) {
    const std::size_t width = std::min<std::size_t>(end - begin, random() % 2 == 0 ? 4 : 8);
    std::size_t at = begin + random() % (end - begin - width + 1);
    if (random() % 4 != 0) at = std::max(begin, at & ~std::size_t{3});
    const std::uint64_t value = random() % 8 == 0 ? random() % 40 : nasty_value(random);
    std::memcpy(&file[at], &value, std::min(width, end - at));
  }
}

TEST(HostileMapFile, WithRightChecksumsIsSoundOrRefused) {
  std::mt19937 random(7);
  std::vector<std::string> files;
  for (const bool exact : {false, true}) files.push_back(bytes_of(sample_snapshot(4), exact));
  files.push_back(bytes_of(sample_snapshot(4, true)));
  const MemoryLimit limit(std::size_t{256} << 20);
  int refused = 0;
  int loaded = 0;
  for (int i = 0; i < 30000; ++i) {
    std::string file = files[random() % files.size()];
    // Every section as often as every other, however small it is.
    const std::size_t table = table_of(file);
    const std::size_t entry = table + 32 * (random() % peek<std::uint32_t>(file, 12));
    const auto offset = peek<std::uint64_t>(file, entry + 8);
    const auto size = std::min<std::uint64_t>(peek<std::uint64_t>(file, entry + 16), 600);
    spoil(file, offset, offset + size, random);
    sign(file);
    survives(file) ? ++loaded : ++refused;
  }
  RecordProperty("refused", refused);
  RecordProperty("loaded", loaded);
  // Some changes are of numbers that may be anything; the others must be found.
  EXPECT_GT(refused, 10000);
  EXPECT_GT(loaded, 3000);
}

TEST(HostileMapFile, WithAWrongTableIsSoundOrRefused) {
  std::mt19937 random(8);
  const std::string good = bytes_of(sample_snapshot(4, false, 20));
  const MemoryLimit limit(std::size_t{256} << 20);
  for (int i = 0; i < 6000; ++i) {
    std::string file = good;
    if (i % 3 == 0) {
      spoil(file, 8, 28, random);  // counts and sizes of the header
      poke(file, 28, crc32c(file.data(), 28));
    } else {
      spoil(file, table_of(file), file.size(), random);
      sign(file);
    }
    survives(file);
  }
}

// A count just within the file's size must not become a multiple of it in memory.
TEST(HostileMapFile, CannotAskForMoreMemoryThanItPaysFor) {
  const std::string good = bytes_of(sample_snapshot(4));
  const MemoryLimit limit(std::size_t{256} << 20);
  const std::size_t table = table_of(good);
  for (std::size_t entry = table; entry < good.size(); entry += 32) {
    const auto offset = peek<std::uint64_t>(good, entry + 8);
    for (const std::uint32_t count : {0xFFFFFFFFU, 0x7FFFFFFFU, 0x10000000U, 0x00100000U}) {
      for (std::size_t at = offset; at < offset + 16 && at + 4 <= table; at += 4) {
        std::string file = good;
        poke(file, at, count);
        sign(file);
        survives(file);
      }
    }
  }
}

// A point that all keyframes see makes every pair of them covisible.
TEST(HostileMapFile, CannotAskForMorePairsOfKeyframesThanItPaysFor) {
  auto frame = std::make_shared<Frame>(*sample_snapshot(4).parts.keyframes.front().frame);
  const auto cut = [](auto& values) { values.resize(1); };
  cut(frame->pixels);
  cut(frame->depths);
  cut(frame->scores);
  cut(frame->sigmas);
  frame->descriptors = frame->descriptors.rowRange(0, 1);
  MapSnapshot snapshot{sample_header(), {}, {}, {}};
  snapshot.parts.rig = Rig(test_camera());
  MapPoint p;
  p.id = p.created_by = 0;
  for (KeyframeId id = 0; id < 8000; ++id) {  // 512 MB of pairs
    Keyframe k;
    k.id = id;
    k.frame = frame;
    k.parent = id == 0 ? kNoId : id - 1;
    snapshot.parts.keyframes.push_back(k);
    p.observations.push_back({id, 0});
  }
  snapshot.parts.last_keyframe = 0;
  snapshot.parts.points.push_back(p);
  EXPECT_FALSE(is_possible_covisibility(snapshot.parts));
  SectionWriter file(0);
  write_header(snapshot.header, snapshot.parts.rig, file);
  write_keyframes(snapshot.parts, file);
  write_keypoints(snapshot.parts, snapshot.header.traits, DescriptorCoding::kInt8, file);
  write_points(snapshot.parts, file);
  const std::string bytes = file.finish();
  const MemoryLimit limit(std::size_t{256} << 20);
  EXPECT_FALSE(survives(bytes));
  const TestFolder folder;
  expect_input_error([&] { save_map(folder / "m", snapshot); }, {"pairs of keyframes"});

  // The same keyframes, each sharing its point with some others.
  snapshot.parts.points.clear();
  for (KeyframeId id = 0; id < 8000; ++id) {
    if (id % 100 == 0) {
      p.observations.clear();
      p.id = static_cast<PointId>(snapshot.parts.points.size());
      snapshot.parts.points.push_back(p);
    }
    snapshot.parts.points.back().observations.push_back({id, 0});
  }
  EXPECT_TRUE(is_possible_covisibility(snapshot.parts));
}

}  // namespace
}  // namespace dxslam
