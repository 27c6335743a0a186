// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/primitives/atomic_file.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <csignal>
#include <future>

#include "io/primitives/test_folder.h"

namespace dxslam {
namespace {

mode_t mode_of(const std::string& path) {
  struct stat status{};
  return ::stat(path.c_str(), &status) == 0 ? status.st_mode & 07777U : 0;
}

std::size_t files_in(const std::string& folder) {
  const std::filesystem::directory_iterator files(folder);
  return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

TEST(AtomicFile, KeepsTheOldFileWhenWritingFails) {
  const TestFolder folder;
  write_file_atomically(folder / "f", "old");
  // A limit on the size of files stands for a full disk.
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1000, 1000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      write_file_atomically(folder / "f", std::string(5000, 'x'));
    } catch (const InputError& e) {
      ::_exit(std::string(e.what()).find("cannot be written") != std::string::npos ? 0 : 2);
    }
    ::_exit(1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_EQ(folder.read("f"), "old");
  EXPECT_EQ(files_in(folder.path()), 1U) << "a temporary file was left behind";
}

TEST(AtomicFile, KeepsTheModeAndTheOwner) {
  const TestFolder folder;
  const std::string file = folder.write("f", "old");
  for (const mode_t mode : {0600U, 0640U, 0666U}) {
    ASSERT_EQ(::chmod(file.c_str(), mode), 0);
    write_file_atomically(file, "new");
    EXPECT_EQ(mode_of(file), mode);
  }
  if (::geteuid() != 0) GTEST_SKIP() << "only root gives files away";
  ASSERT_EQ(::chown(file.c_str(), 1234, 4321), 0);
  write_file_atomically(file, "newer");
  struct stat status{};
  ASSERT_EQ(::stat(file.c_str(), &status), 0);
  EXPECT_EQ(status.st_uid, 1234U);
  EXPECT_EQ(status.st_gid, 4321U);
  EXPECT_EQ(folder.read("f"), "newer");
}

TEST(AtomicFile, DoesNotReplaceWhatIsProtected) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const TestFolder folder;
  const std::string file = folder.write("f", "old");
  ASSERT_EQ(::chmod(file.c_str(), 0444), 0);
  expect_input_error([&] { write_file_atomically(file, "x"); }, {"f", "Permission denied"});
  expect_input_error([&] { require_writable(file); }, {"f", "Permission denied"});
  EXPECT_EQ(folder.read("f"), "old");
}

TEST(AtomicFile, WritesThroughLinksAndToDevices) {
  const TestFolder folder;
  folder.write("target", "old");
  std::filesystem::create_symlink("target", folder / "link");
  write_file_atomically(folder / "link", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(folder.read("target"), "new");
  std::filesystem::remove(folder / "target");
  write_file_atomically(folder / "link", "newer");
  EXPECT_EQ(folder.read("target"), "newer") << "a link to what is missing";
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  expect_input_error([&] { write_file_atomically(folder.path(), "x"); }, {"cannot be written"});
  if (!std::filesystem::exists("/dev/full")) return;
  expect_input_error([] { write_file_atomically("/dev/full", "x"); }, {"No space left"});
}

TEST(AtomicFile, WritesToAPipeThatIsRead) {
  const TestFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  expect_input_error([&] { write_file_atomically(folder / "pipe", "text"); },
                     {"pipe", "nobody reads"});
  expect_input_error([&] { require_writable(folder / "pipe"); }, {"pipe", "nobody reads"});
  const int reader = ::open((folder / "pipe").c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_EQ(::fcntl(reader, F_SETFL, 0), 0);
  const std::string text(300'000, 'x');  // more than a pipe holds
  auto writing =
      std::async(std::launch::async, [&] { write_file_atomically(folder / "pipe", text); });
  std::string got;
  char piece[4096];
  while (got.size() < text.size()) {
    const ssize_t count = ::read(reader, piece, sizeof piece);
    if (count > 0) got.append(piece, static_cast<std::size_t>(count));
    if (count < 0) break;
  }
  writing.get();
  EXPECT_EQ(got, text);
  ::close(reader);
  EXPECT_TRUE(std::filesystem::is_fifo(folder / "pipe"));
}

TEST(AtomicFile, GivesUpAPipeWhenItMustNotWait) {
  const TestFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  const int reader = ::open((folder / "pipe").c_str(), O_RDONLY | O_NONBLOCK);
  const pid_t child = ::fork();
  if (child == 0) {
    stop_waiting_for_readers();
    try {
      write_file_atomically(folder / "pipe", std::string(300'000, 'x'));
    } catch (const InputError&) {
      ::_exit(0);
    }
    ::_exit(1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  ::close(reader);
}

TEST(AtomicFile, WritesToStdoutWhereItStands) {
  const TestFolder folder;
  const pid_t child = ::fork();
  if (child == 0) {
    const int file = ::open((folder / "out").c_str(), O_WRONLY | O_CREAT, 0600);
    ::dup2(file, STDOUT_FILENO);
    const bool begun = ::write(STDOUT_FILENO, "a", 1) == 1;
    write_file_atomically("/dev/stdout", "b");
    ::_exit(begun && ::write(STDOUT_FILENO, "c", 1) == 1 ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_EQ(folder.read("out"), "abc");
}

TEST(AtomicFile, ReplacesAndNamesWhatFailed) {
  const TestFolder folder;
  write_file_atomically(folder / "f", "old");
  write_file_atomically(folder / "f", "newer");
  EXPECT_EQ(folder.read("f"), "newer");
  expect_input_error([&] { write_file_atomically(folder / "no/f", "x"); },
                     {"no/f", "cannot be written", "No such file"});
  expect_input_error([&] { write_file_atomically(folder / "f/g", "x"); }, {"Not a directory"});
  expect_input_error([&] { write_file_atomically(folder / std::string(256, 'n'), "x"); },
                     {"cannot be written", "name too long"});
  const std::string longest(255, 'n');
  write_file_atomically(folder / longest, "x");
  EXPECT_EQ(folder.read(longest), "x");
}

TEST(AtomicFile, TriesATargetWithoutTouchingIt) {
  const TestFolder folder;
  folder.write("f", "old");
  require_writable(folder / "f");
  require_writable(folder / "new");
  EXPECT_EQ(folder.read("f"), "old");
  EXPECT_EQ(files_in(folder.path()), 1U);
  expect_input_error([&] { require_writable(folder / "no/f"); }, {"no/f", "No such file"});
  expect_input_error([&] { require_writable(folder.path()); }, {"cannot be written"});
  expect_input_error([&] { make_folder(folder / "f"); }, {"f", "cannot be made"});
  std::filesystem::create_symlink("nowhere", folder / "link");
  expect_input_error([&] { make_folder(folder / "link"); }, {"link", "to nowhere", "not there"});
  expect_input_error([&] { make_folder(folder / std::string(300, 'n')); }, {"name too long"});
}

}  // namespace
}  // namespace dxslam
