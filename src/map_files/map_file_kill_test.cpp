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

#include "io/test_folder.h"
#include "map_files/test_map_files.h"

namespace dxslam {
namespace {

constexpr int kKills = 200;

// Runs in the child: saves two maps in turns until it is killed.
[[noreturn]] void save_for_ever(const std::string& path, const MapSnapshot& small,
                                const MapSnapshot& large) {
  for (;;) {
    try {
      save_map(path, small);
      save_map(path, large);
    } catch (...) {
      ::_exit(1);
    }
  }
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
  save_map(path, large);
  const std::string large_bytes = folder.read("m.dxmap");
  std::mt19937 random(9);
  int found_small = 0;
  int found_large = 0;
  std::size_t interrupted = 0;  // killed between the start of a file and its new name
  for (int i = 0; i < kKills; ++i) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) save_for_ever(path, small, large);
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 20000));
    ::kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the child could not save";
    const StoredMap stored = load_map(path);
    const bool is_small = stored.map.keyframe_count() == small.parts.keyframes.size();
    ASSERT_EQ(folder.read("m.dxmap"), is_small ? small_bytes : large_bytes);
    ++(is_small ? found_small : found_large);
    interrupted += temporaries(folder.path());
    // The next child clears up before it saves.
  }
  RecordProperty("old_or_new", std::to_string(found_small) + " " + std::to_string(found_large));
  RecordProperty("killed_while_writing", std::to_string(interrupted));
  EXPECT_GT(found_small, 5);
  EXPECT_GT(found_large, 5);
  EXPECT_GT(interrupted, 10U) << "hardly ever killed while a file was being written";
  save_map(path, small);
  EXPECT_EQ(temporaries(folder.path()), 0U) << "what the killed left behind is not cleared up";
}

}  // namespace
}  // namespace dxslam
