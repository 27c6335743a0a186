// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/network/model_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <thread>

#include "io/primitives/test_folder.h"

namespace dxslam {
namespace {

std::string only_file_in(const std::string& folder) {
  std::string found;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    EXPECT_EQ(found, "") << entry.path();
    found = entry.path().filename().string();
  }
  return found;
}

TEST(ModelCache, GivesBackWhatWasStoredUnderTheKey) {
  const TestFolder folder;
  const ModelCache cache(folder / "a/b");
  EXPECT_EQ(cache.note(), "");
  EXPECT_FALSE(cache.load("key"));
  cache.store("key", "content");
  EXPECT_EQ(ModelCache(folder / "a/b").load("key"), "content");
  EXPECT_FALSE(cache.load("other key"));
}

TEST(ModelCache, RemovesFilesThatWereCutOrAlteredAnywhere) {
  const TestFolder folder;
  const ModelCache cache(folder.path());
  cache.store("key", "some content");
  const std::string name = only_file_in(folder.path());
  const std::string good = folder.read(name);
  for (std::size_t at = 0; at < good.size(); ++at) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 4);
    folder.write(name, bad);
    EXPECT_FALSE(cache.load("key")) << at;
    EXPECT_FALSE(std::filesystem::exists(folder / name)) << at;
    folder.write(name, good.substr(0, at));
    EXPECT_FALSE(cache.load("key")) << at;
  }
  folder.write(name, good);
  EXPECT_EQ(cache.load("key"), "some content");
  cache.store("second key", "other content");
  std::filesystem::remove(folder / name);
  std::filesystem::rename(folder / only_file_in(folder.path()), folder / name);
  EXPECT_FALSE(cache.load("key")) << "of another key";
}

// Opening a pipe would wait for ever.
TEST(ModelCache, TakesWhatIsNoFileForNothing) {
  const TestFolder folder;
  const ModelCache cache(folder.path());
  cache.store("key", "content");
  const std::string name = only_file_in(folder.path());
  std::filesystem::remove(folder / name);
  ASSERT_EQ(::mkfifo((folder / name).c_str(), 0600), 0);
  EXPECT_FALSE(cache.load("key"));
  cache.store("key", "content");
  EXPECT_EQ(cache.load("key"), "content");
  std::filesystem::remove(folder / name);
  std::filesystem::create_directories((folder / name) + "/sub");
  EXPECT_FALSE(cache.load("key"));
  cache.store("key", "content");
}

TEST(ModelCache, IsNotUsedWhereItCannotBeWritten) {
  const TestFolder folder;
  folder.write("file", "");
  for (const std::string& place :
       {folder / "file", folder / "file/dxslam", std::string("/proc/x")}) {
    const ModelCache cache(place);
    EXPECT_THAT(cache.note(), testing::HasSubstr(place));
    EXPECT_FALSE(cache.usable());
    cache.store("key", "content");
    EXPECT_FALSE(cache.load("key"));
  }
  EXPECT_EQ(ModelCache("").note(), "");
  EXPECT_FALSE(ModelCache("").usable());
}

TEST(ModelCache, ServesManyAtATime) {
  const TestFolder folder;
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      const ModelCache cache(folder.path());
      for (int k = 0; k < 50; ++k) {
        cache.store("key", std::string(10000, 'x'));
        const auto found = cache.load("key");
        EXPECT_TRUE(!found || *found == std::string(10000, 'x'));
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace dxslam
