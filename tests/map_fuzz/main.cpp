// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// Maps that were made to do harm: small maps that the system made, mutated, with all checksums
// right, each loaded and then used for everything. A case may be refused or used; anything else is
// told with what repeats it: map_fuzz --seed SEED --only CASE.
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <new>
#include <optional>
#include <thread>
#include <typeinfo>

#include "trial.h"

namespace {

using namespace dxslam;
using namespace dxslam::fuzz;
using Clock = std::chrono::steady_clock;

struct Settings {
  std::uint64_t seed = 1;
  std::uint64_t first = 0;
  std::uint64_t cases = 300;
  std::optional<std::uint64_t> only;
  double limit = 30.0;  // seconds for one case, on the clock
  std::uint64_t chunk = 1000;
};

// Shared by the process that runs cases and the one that watches over it.
struct Progress {
  std::atomic<std::uint64_t> current{0};  // case
  std::atomic<bool> begun{false};         // the maps to be spoiled are made
  std::atomic<std::uint64_t> refused{0}, used{0}, localized{0}, tracked{0}, joined{0}, merged{0};
  std::atomic<std::uint64_t> findings{0};
  std::atomic<std::uint64_t> slowest{0};
  std::atomic<double> slowest_s{0.0};
};

// Of the processor, however busy it is with others.
double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void tell(const Settings& settings, std::uint64_t number, const std::string& what) {
  fmt::print("FINDING --seed {} --only {}: {}\n", settings.seed, number, what);
  std::fflush(stdout);
}

void count(const TrialReport& report, Progress& progress) {
  (report.outcome == Outcome::kUsed ? progress.used : progress.refused) += 1;
  progress.localized += report.localized ? 1 : 0;
  progress.tracked += report.tracked ? 1 : 0;
  progress.joined += report.joined ? 1 : 0;
  progress.merged += static_cast<std::uint64_t>(report.merged);
}

void run_case(const Settings& settings, const BaseMaps& bases, std::uint64_t number,
              const std::string& folder, Progress& progress) {
  const double start = cpu_seconds();
  try {
    count(try_case(bases, settings.seed, number, folder), progress);
  } catch (const std::exception& e) {
    progress.findings += 1;
    tell(settings, number, fmt::format("{}: {}", typeid(e).name(), e.what()));
  }
  const double took = cpu_seconds() - start;
  if (took > progress.slowest_s) {
    progress.slowest_s = took;
    progress.slowest = number;
  }
}

std::string folder_of(pid_t process) {
  const auto all = std::filesystem::temp_directory_path();
  return (all / fmt::format("dxslam_map_fuzz_{}", process)).string();
}

// In a folder of its own, which is gone afterwards.
void run_cases(const Settings& settings, std::uint64_t first, std::uint64_t end,
               Progress& progress) {
  const std::string folder = folder_of(::getpid());
  std::filesystem::create_directory(folder);
  {
    const BaseMaps bases(folder);
    progress.begun = true;
    for (std::uint64_t i = first; i < end; ++i) {
      progress.current = i;
      run_case(settings, bases, i, folder, progress);
    }
  }
  std::filesystem::remove_all(folder);
}

// True if the process ended well; false, and it is told, if it crashed or took too long.
bool watch(const Settings& settings, pid_t child, Progress& progress) {
  std::uint64_t seen = progress.current;
  Clock::time_point since = Clock::now();
  int status = 0;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (seen != progress.current) {
      seen = progress.current;
      since = Clock::now();
    } else if (seconds_since(since) > settings.limit) {
      ::kill(child, SIGKILL);
      ::waitpid(child, &status, 0);
      tell(settings, progress.current, fmt::format("took more than {} s", settings.limit));
      return false;
    }
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return true;
  const std::string how = WIFSIGNALED(status) ? fmt::format("signal {}", WTERMSIG(status))
                                              : fmt::format("exit code {}", WEXITSTATUS(status));
  tell(settings, progress.current, how + " (a leak: in one of the cases before)");
  return false;
}

// Cases run in other processes, a chunk each, so that a crash costs one case.
void run_chunks(const Settings& settings, Progress& progress) {
  const std::uint64_t end = settings.first + settings.cases;
  const Clock::time_point start = Clock::now();
  std::uint64_t next = settings.first;
  while (next < end && (next == settings.first || progress.begun)) {
    const std::uint64_t chunk_end = std::min(end, next + settings.chunk);
    progress.current = next;
    std::fflush(stdout);
    const pid_t child = ::fork();
    if (child == 0) {
      run_cases(settings, next, chunk_end, progress);
      std::exit(0);
    }
    const bool whole = watch(settings, child, progress);
    if (!whole) progress.findings += 1;
    std::filesystem::remove_all(folder_of(child));
    next = whole ? chunk_end : progress.current + 1;
    fmt::print(
        "{} cases: {} refused, {} used ({} localized, {} tracked, {} joined, {} merged), {} "
        "findings, {:.0f} s, slowest {:.2f} s (case {})\n",
        next - settings.first, progress.refused, progress.used, progress.localized,
        progress.tracked, progress.joined, progress.merged, progress.findings, seconds_since(start),
        progress.slowest_s, progress.slowest);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app("Loads and uses maps that were mutated under right checksums");
  app.add_option("--seed", settings.seed, "the cases follow from it");
  app.add_option("--first", settings.first, "number of the first case");
  app.add_option("--cases", settings.cases, "how many");
  app.add_option("--only", settings.only, "this case alone, in this process");
  app.add_option("--limit", settings.limit, "seconds that a case may take");
  app.add_option("--chunk", settings.chunk, "cases a process")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  void* shared =
      ::mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) return 1;
  Progress& progress = *new (shared) Progress;
  if (settings.only) {
    run_cases(settings, *settings.only, *settings.only + 1, progress);
  } else {
    run_chunks(settings, progress);
  }
  return progress.findings == 0 ? 0 : 1;
}
