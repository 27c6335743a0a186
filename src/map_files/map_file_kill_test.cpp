// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors

// A process that is killed while it saves, at any moment, loses nothing: the file is the old one or
// the new one, whole.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <random>
#include <thread>

#include "io/primitives/test_folder.h"
#include "map_files/test_map_files.h"

namespace dxslam {
namespace {

constexpr int kKills = 200;

// Runs in the child: saves two maps in turns until it is killed, and says when it has begun.
[[noreturn]] void save_for_ever(const std::string& path, const MapSnapshot& small,
                                const MapSnapshot& large, int begun) {
  for (bool first = true;; first = false) {
    try {
      save_map(path, small);
      if (first && ::write(begun, "x", 1) != 1) ::_exit(2);
      save_map(path, large);
    } catch (...) {
      ::_exit(1);
    }
  }
}

// Starts the saving child, kills it within `span` after it has begun, and returns how it ended.
int run_and_kill(const std::string& path, const MapSnapshot& small, const MapSnapshot& large,
                 std::chrono::microseconds span, std::mt19937& random) {
  int ends[2];
  if (::pipe(ends) != 0) return 0;
  const pid_t child = ::fork();
  if (child == 0) save_for_ever(path, small, large, ends[1]);
  ::close(ends[1]);
  char begun = 0;
  EXPECT_EQ(::read(ends[0], &begun, 1), 1);
  ::close(ends[0]);
  std::this_thread::sleep_for(span * (random() % 1000) / 1000);
  ::kill(child, SIGKILL);
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  return status;
}

std::size_t temporaries(const std::string& folder) {
  std::size_t count = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    count += file.path().extension() == ".tmp" ? 1 : 0;
  }
  return count;
}

TEST(KilledWhileSaving, LeavesTheOldOrTheNewMapWhole) {
  const TestFolder folder;
  const std::string path = folder / "m.dxmap";
  const MapSnapshot small = sample_snapshot(4, false, 40);
  const MapSnapshot large = sample_snapshot(12, false, 400);
  save_map(path, small);
  const std::string small_bytes = folder.read("m.dxmap");
  const auto start = std::chrono::steady_clock::now();
  save_map(path, large);
  const auto span = std::chrono::duration_cast<std::chrono::microseconds>(
      4 * (std::chrono::steady_clock::now() - start));
  const std::string large_bytes = folder.read("m.dxmap");
  std::mt19937 random(9);
  int found_small = 0;
  int found_large = 0;
  for (int i = 0; i < kKills; ++i) {
    const int status = run_and_kill(path, small, large, span, random);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the child could not save";
    const StoredMap stored = load_map(path);
    const bool is_small = stored.map.keyframe_count() == small.parts.keyframes.size();
    ASSERT_EQ(folder.read("m.dxmap"), is_small ? small_bytes : large_bytes);
    ++(is_small ? found_small : found_large);
    ASSERT_LE(temporaries(folder.path()), 1U) << "each child clears up before it saves";
  }
  RecordProperty("old_or_new", std::to_string(found_small) + " " + std::to_string(found_large));
  EXPECT_GT(found_small, 0);
  EXPECT_GT(found_large, 0);
  save_map(path, small);
  EXPECT_EQ(temporaries(folder.path()), 0U) << "what the killed left behind is not cleared up";
}

}  // namespace
}  // namespace dxslam
