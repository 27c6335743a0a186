// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/result_folder.h"

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <csignal>

#include <set>

#include "io/primitives/atomic_file.h"
#include "io/primitives/test_folder.h"

namespace dxslam {
namespace {

namespace fs = std::filesystem;

FileKind result_kind() {
  return {"a result", [](std::string_view head) { return !head.starts_with("precious"); }};
}

ResultFiles run_files() {
  return {{{"trajectory.txt", result_kind()},
           {"map_[0-9]*.txt", result_kind()},
           {"summary.json", result_kind()}},
          {"summary.json"},
          {"trajectory.txt"}};
}

std::set<std::string> files_in(const std::string& folder) {
  std::set<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; ++it) {
    if (it->is_regular_file()) names.insert(it->path().filename().string());
  }
  return names;
}

using Names = std::set<std::string>;

// A run with results of `text` that ends as it should.
void write_results(const TestFolder& folder, const std::string& text, bool with_map = false) {
  ResultFolder results(folder.path(), run_files());
  results.begin();
  write_file_atomically(results.file("trajectory.txt"), text);
  if (with_map) write_file_atomically(results.file("map_1.txt"), text);
  write_file_atomically(results.file("summary.json"), text);
  results.finish();
}

TEST(ResultFolder, ReplacesAllResultsAndNothingElse) {
  const TestFolder folder;
  folder.write("notes.txt", "mine");
  folder.write("map_of_town.txt", "mine");
  write_results(folder, "first", true);
  write_results(folder, "second");
  EXPECT_EQ(files_in(folder.path()),
            (Names{"trajectory.txt", "summary.json", "notes.txt", "map_of_town.txt"}));
  EXPECT_EQ(folder.read("trajectory.txt"), "second");
  EXPECT_FALSE(fs::exists(folder / "previous"));
}

TEST(ResultFolder, TouchesNothingBeforeTheBeginning) {
  const TestFolder folder;
  write_results(folder, "first", true);
  {
    const ResultFolder results(folder.path(), run_files());
  }
  EXPECT_EQ(files_in(folder.path()), (Names{"trajectory.txt", "summary.json", "map_1.txt"}));
  const std::string missing = folder / "new";
  {
    const ResultFolder results(missing, run_files());
  }
  EXPECT_FALSE(fs::exists(missing));
}

TEST(ResultFolder, KeepsTheLastResultsApartUntilTheNewOnesAreWhole) {
  const TestFolder folder;
  write_results(folder, "first", true);
  for (int killed = 0; killed < 2; ++killed) {  // not finished: as if it had been killed
    ResultFolder results(folder.path(), run_files());
    results.begin();
    folder.write("trajectory.txt", "unfinished");
  }
  EXPECT_EQ(files_in(folder.path()), (Names{"trajectory.txt"}));
  EXPECT_EQ(files_in(folder / "previous"), (Names{"trajectory.txt", "summary.json", "map_1.txt"}));
  EXPECT_EQ(folder.read("previous/trajectory.txt"), "first");
  write_results(folder, "second");
  EXPECT_EQ(files_in(folder.path()), (Names{"trajectory.txt", "summary.json"}));
  EXPECT_FALSE(fs::exists(folder / "previous"));
}

TEST(ResultFolder, ResultsWithoutContentDoNotReplaceThoseWith) {
  const TestFolder folder;
  write_results(folder, "# stamps\n1 2 3\n");
  for (int run = 0; run < 2; ++run) {
    write_results(folder, "# stamps\n");
    EXPECT_EQ(folder.read("trajectory.txt"), "# stamps\n");
    EXPECT_EQ(folder.read("previous/trajectory.txt"), "# stamps\n1 2 3\n");
  }
}

TEST(ResultFolder, KeepsTheLastResultsUntilARunEndsWell) {
  const TestFolder folder;
  write_results(folder, "first", true);
  for (int stopped = 0; stopped < 2; ++stopped) {  // whole, but of fewer frames
    ResultFolder results(folder.path(), run_files());
    EXPECT_EQ(results.kept(), stopped == 0 ? "" : folder / "previous");
    results.begin();
    write_file_atomically(results.file("trajectory.txt"), "stopped");
    write_file_atomically(results.file("summary.json"), "stopped");
    EXPECT_EQ(results.kept(), folder / "previous");
  }
  EXPECT_EQ(folder.read("trajectory.txt"), "stopped");
  EXPECT_EQ(files_in(folder / "previous"), (Names{"trajectory.txt", "summary.json", "map_1.txt"}));
  EXPECT_EQ(folder.read("previous/trajectory.txt"), "first");
  write_results(folder, "second");
  EXPECT_FALSE(fs::exists(folder / "previous"));
}

TEST(ResultFolder, HoldsResultsInFoldersOfItsOwn) {
  const TestFolder folder;
  ResultFiles files = run_files();
  files.folders = {"a", "b"};
  const auto write_all = [&](const std::string& text, bool ends_well) {
    ResultFolder results(folder.path(), files);
    results.begin();
    EXPECT_FALSE(fs::exists(folder / "b/trajectory.txt"));
    for (const char* name :
         {"b/trajectory.txt", "b/summary.json", "trajectory.txt", "summary.json"}) {
      make_folder((fs::path(results.file(name))).parent_path().string());
      write_file_atomically(results.file(name), text);
    }
    if (ends_well) results.finish();
  };
  folder.write("a/notes.txt", "mine");
  write_all("first", true);
  write_all("second", false);
  EXPECT_EQ(folder.read("previous/b/trajectory.txt"), "first");
  EXPECT_EQ(folder.read("b/trajectory.txt"), "second");
  write_all("third", true);
  EXPECT_FALSE(fs::exists(folder / "previous"));
  EXPECT_EQ(folder.read("b/summary.json"), "third");
  EXPECT_EQ(folder.read("a/notes.txt"), "mine");
  EXPECT_TRUE(ResultFolder(folder.path(), files).claims(folder / "b/map_1.txt"));
  folder.write("b/trajectory.txt", "precious");
  expect_input_error([&] { ResultFolder(folder.path(), files); }, {"b/trajectory.txt"});
}

TEST(ResultFolder, IsMadeAgainWhereItWasRemovedOrMoved) {
  const TestFolder folder;
  const std::string out = folder / "out";
  {
    ResultFolder results(out, run_files());
    results.begin();
    fs::remove_all(out);
    results.begin();
    write_file_atomically(results.file("summary.json"), "{}");
    fs::rename(out, folder / "moved");
    results.begin();
    write_file_atomically(results.file("summary.json"), "{}");
    expect_input_error([&] { ResultFolder(out, run_files()); }, {"in use by another run"});
  }
  EXPECT_EQ(files_in(out), (Names{"summary.json"}));
  EXPECT_EQ(files_in(folder / "moved"), (Names{"summary.json"}));  // and no lock
}

// Killed at any moment, the last results are whole: in place, in `previous`, or, while they are
// moved, in two folders of which the next run makes one.
TEST(ResultFolder, SurvivesAKillAtAnyTime) {
  for (int delay = 0; delay < 40; ++delay) {
    const TestFolder folder;
    write_results(folder, "first", true);
    const pid_t child = ::fork();
    if (child == 0) {
      for (;;) write_results(folder, "second", true);
    }
    ::usleep(static_cast<useconds_t>(100 * delay));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    const Names whole{"trajectory.txt", "summary.json", "map_1.txt"};
    ResultFolder next(folder.path(), run_files());
    next.begin();
    EXPECT_EQ(files_in(folder / "previous"), whole);
    const std::string text = folder.read("previous/trajectory.txt");
    EXPECT_TRUE(text == "first" || text == "second");
    EXPECT_EQ(folder.read("previous/map_1.txt"), text);
    EXPECT_EQ(folder.read("previous/summary.json"), text);
  }
}

TEST(ResultFolder, BelongsToOneRun) {
  const TestFolder folder;
  {
    const ResultFolder results(folder.path(), run_files());
    expect_input_error([&] { ResultFolder(folder.path(), run_files()); },
                       {folder.path(), "in use by another run"});
  }
  EXPECT_TRUE(files_in(folder.path()).empty());
  const ResultFolder results(folder.path(), run_files());
}

TEST(ResultFolder, RefusesFoldersThatItCannotUse) {
  const TestFolder folder;
  folder.write("file", "text");
  expect_input_error([&] { ResultFolder(folder / "file", run_files()); }, {"file"});
  folder.write("previous/holiday.jpg", "mine");
  expect_input_error([&] { ResultFolder(folder.path(), run_files()); }, {"previous/holiday.jpg"});
  EXPECT_EQ(folder.read("previous/holiday.jpg"), "mine");
}

// Opening a pipe would wait for ever, in the constructor or at the first pose.
TEST(ResultFolder, RefusesWhatIsNoFileInThePlaceOfAResult) {
  const TestFolder folder;
  ASSERT_EQ(::mkfifo((folder / "trajectory.txt").c_str(), 0600), 0);
  expect_input_error([&] { ResultFolder(folder.path(), run_files()); },
                     {"trajectory.txt", "no regular file"});
  fs::remove(folder / "trajectory.txt");
  fs::create_directory(folder / "summary.json");
  expect_input_error([&] { ResultFolder(folder.path(), run_files()); }, {"summary.json"});
  fs::remove(folder / "summary.json");
  fs::create_symlink("nowhere", folder / "map_1.txt");
  ResultFolder results(folder.path(), run_files());
  ASSERT_EQ(::mkfifo((folder / "trajectory.txt").c_str(), 0600), 0);  // while it runs
  results.begin();
}

TEST(ResultFolder, RefusesFilesOfOthersInThePlaceOfResults) {
  const TestFolder folder;
  for (const char* name : {"trajectory.txt", "map_3.txt", "previous/summary.json"}) {
    folder.write(name, "precious");
    expect_input_error([&] { ResultFolder(folder.path(), run_files()); },
                       {name, "is not a result", "not replaced"});
    EXPECT_EQ(folder.read(name), "precious");
    EXPECT_FALSE(fs::exists(folder / ".dxslam.lock"));
    fs::remove(folder / name);
  }
  fs::remove(folder / "previous");
  folder.write("previous", "mine");
  expect_input_error([&] { ResultFolder(folder.path(), run_files()); }, {"previous", "no folder"});
  EXPECT_EQ(folder.read("previous"), "mine");
  fs::remove(folder / "previous");
  folder.write("trajectory.txt", "");
  ResultFolder(folder.path(), run_files()).begin();
}

TEST(ResultFolder, ClaimsWhatItReplacesOrRemoves) {
  const TestFolder folder;
  fs::create_directory(folder / "other");
  fs::create_symlink(folder.path(), folder / "other/link");
  folder.write("map_2.txt", "a result");
  fs::create_symlink("map_2.txt", folder / "leads_there");
  const ResultFolder results(folder.path(), run_files());
  for (const char* name :
       {"trajectory.txt", "map_12.txt", "other/../summary.json", "previous", "previous/m.dxmap",
        ".", "other/link/map_1.txt", "leads_there", ".dxslam.lock"}) {
    EXPECT_TRUE(results.claims(folder / name)) << name;
  }
  for (const char* name : {"m.dxmap", "map_of_town.txt", "other/trajectory.txt", "previous_map"}) {
    EXPECT_FALSE(results.claims(folder / name)) << name;
  }
  EXPECT_FALSE(results.claims("trajectory.txt"));
}

}  // namespace
}  // namespace dxslam
