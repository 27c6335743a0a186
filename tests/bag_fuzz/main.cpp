// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// Bags that were made to do harm: those of tests/data/bags, mutated, each opened and read to its
// end. A case may be refused in one sentence or used; anything else is told with what repeats it:
// bag_fuzz --seed SEED --first CASE --cases 1. What crashes leaves its file in the temporary
// folder.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <typeinfo>

#include "core/error.h"
#include "io/primitives/text_file.h"
#include "io/recordings/recording_info.h"

namespace {

using namespace dxslam;
namespace fs = std::filesystem;

struct Settings {
  std::string bags;
  std::uint64_t seed = 1;
  std::uint64_t first = 0;
  std::uint64_t cases = 300;
  double limit = 30.0;  // seconds of the processor for one case
};

struct Base {
  std::string ending;
  std::string bytes;
};

std::vector<Base> read_bases(const std::string& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    const std::string ending = entry.path().extension().string();
    if (ending == ".bag" || ending == ".mcap" || ending == ".db3") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<Base> bases;
  for (const fs::path& file : files) {
    bases.push_back({file.extension().string(), read_file(file.string(), "a bag")});
  }
  return bases;
}

/// Changes a bag at a place where headers, indexes or messages are likely.
class Mutation {
 public:
  Mutation(std::string bytes, std::mt19937& random) : bytes_(std::move(bytes)), random_(random) {}

  std::string apply() {
    for (std::size_t left = 1 + below(6); left > 0 && !bytes_.empty(); --left) change(place());
    return bytes_;
  }

 private:
  std::size_t below(std::size_t end) { return random_() % end; }

  std::size_t place() {
    constexpr std::size_t kHead = 4096;
    const std::size_t edge = std::min(bytes_.size(), kHead);
    switch (below(4)) {
      case 0:
        return below(edge);
      case 1:
        return bytes_.size() - 1 - below(edge);
      default:
        return below(bytes_.size());
    }
  }

  void change(std::size_t at) {
    switch (below(6)) {
      case 0:
        bytes_[at] = static_cast<char>(random_());
        break;
      case 1:
        bytes_[at] = static_cast<char>(bytes_[at] ^ (1 << below(8)));
        break;
      case 2:
        write_length(at);
        break;
      case 3:
        bytes_.erase(at, below(64));
        break;
      case 4:
        bytes_.insert(at, bytes_.substr(below(bytes_.size()), below(256)));
        break;
      default:
        if (below(6) == 0) bytes_.resize(at);
    }
  }

  void write_length(std::size_t at) {
    static constexpr std::uint32_t kLengths[] = {0,          1,         0xFFFF,     1U << 20U,
                                                 0x7FFFFFFF, 1U << 30U, 0x80000000, 0xFFFFFFFF};
    const std::uint32_t length = kLengths[below(std::size(kLengths))];
    for (std::size_t i = 0; i < 4 && at + i < bytes_.size(); ++i) {
      bytes_[at + i] = static_cast<char>(length >> (8 * i));
    }
  }

  std::string bytes_;
  std::mt19937& random_;
};

// True for a recording that was read to its end. Throws InputError for one that is refused.
bool use(const std::string& file) {
  const RecordingInfo info = inspect_recording(file, {});
  if (info.origin == nullptr) throw InputError(info.problem);
  const std::unique_ptr<RgbdSequence> sequence = open_sequence(file);
  for (std::size_t i = 0; i < sequence->size(); ++i) sequence->read(i);
  return true;
}

// What must not be, or nothing.
std::string find_fault(const std::string& file, double limit, bool& used) {
  const std::clock_t start = std::clock();
  try {
    used = use(file);
  } catch (const InputError& e) {
    if (std::string(e.what()).find('\n') != std::string::npos) {
      return fmt::format("refused in several lines: {}", e.what());
    }
  } catch (const std::exception& e) {
    return fmt::format("{}: {}", typeid(e).name(), e.what());
  }
  const double took = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return took > limit ? fmt::format("took {:.1f} s", took) : std::string();
}

int run(const Settings& settings) {
  const std::vector<Base> bases = read_bases(settings.bags);
  const fs::path folder = fs::temp_directory_path() / fmt::format("dxslam_bag_fuzz_{}", ::getpid());
  fs::create_directory(folder);
  std::uint64_t usable = 0;
  std::uint64_t findings = 0;
  for (std::uint64_t i = settings.first; i < settings.first + settings.cases; ++i) {
    std::mt19937 random(static_cast<std::uint32_t>(settings.seed * 1'000'003 + i));
    const Base& base = bases.at(random() % bases.size());
    const fs::path file = folder / fmt::format("case_{}{}", i, base.ending);
    std::ofstream(file, std::ios::binary) << Mutation(base.bytes, random).apply();
    bool used = false;
    const std::string fault = find_fault(file.string(), settings.limit, used);
    fs::remove(file);
    usable += used ? 1 : 0;
    if (fault.empty()) continue;
    ++findings;
    fmt::print("FINDING --seed {} --first {}: {}\n", settings.seed, i, fault);
  }
  fs::remove_all(folder);
  fmt::print("{} cases: {} used, {} findings\n", settings.cases, usable, findings);
  return findings == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app("Opens and reads bags that were mutated");
  app.add_option("BAGS", settings.bags, "folder of whole bags")->required();
  app.add_option("--seed", settings.seed, "the cases follow from it");
  app.add_option("--first", settings.first, "number of the first case");
  app.add_option("--cases", settings.cases, "how many");
  app.add_option("--limit", settings.limit, "seconds of the processor that a case may take");
  CLI11_PARSE(app, argc, argv);
  return run(settings);
}
