// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// Whether memory stays what it was: the same short walk again and again, and the heap in use after
// some and after many frames, for mapping and for localization. benchmarks/memory/run runs it.
#include <fmt/format.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "features/extractor_factory.h"
#include "io/recordings/sequence_reader.h"
#include "map/map_parts.h"
#include "slam/system.h"

namespace {

using namespace dxslam;

struct Settings {
  std::string sequence;
  std::string features = "auto";
  std::vector<std::string> modes = {"slam", "localization"};
  std::size_t first = 2000;
  std::size_t frames = 20000;
  bool deterministic = false;
};

// Bytes that the program holds, without what the allocator keeps for later.
std::size_t heap_in_use() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

double mib(std::size_t bytes) { return static_cast<double>(bytes) / (1 << 20); }

SystemOptions options_of(const Settings& settings, const std::string& mode) {
  SystemOptions options;
  options.features = settings.features == "auto" ? choose_extractor().name : settings.features;
  options.mode = mode;
  options.deterministic = settings.deterministic;
  options.extractor.deterministic = settings.deterministic;
  return options;
}

// Feeds the recording over and over and tells the heap, averaged over one walk, since it goes up
// and down with the frames that are under way.
class EndlessWalk {
 public:
  EndlessWalk(RgbdSequence& sequence, System& system) : sequence_(sequence), system_(system) {}

  std::size_t heap_after(std::size_t frames) {
    while (fed_ + sequence_.size() < frames) walk();
    return walk();
  }

 private:
  std::size_t walk() {
    if (fed_ > 0) system_.begin_sequence();
    double sum = 0.0;
    for (std::size_t i = 0; i < sequence_.size(); ++i, ++fed_) {
      std::optional<RgbdImage> image = sequence_.read(i);
      if (!image) throw InputError("a frame cannot be read, expected a recording without gaps");
      image->index = static_cast<std::int64_t>(fed_);
      image->stamp = static_cast<double>(fed_) / 30.0;
      system_.process(*image);
      sum += static_cast<double>(heap_in_use());
    }
    return static_cast<std::size_t>(sum / static_cast<double>(sequence_.size()));
  }

  RgbdSequence& sequence_;
  System& system_;
  std::size_t fed_ = 0;
};

Map known_map(const Settings& settings, RgbdSequence& sequence) {
  const SystemOptions options = options_of(settings, "slam");
  System system(sequence.camera(), make_extractor(options.features, options.extractor), options);
  EndlessWalk(sequence, system).heap_after(1);
  system.finish();
  return Map(take_apart(system.map()));
}

void measure(const Settings& settings, RgbdSequence& sequence, const std::string& mode) {
  const SystemOptions options = options_of(settings, mode);
  Map map;
  if (mode == "localization") map = known_map(settings, sequence);
  System system(sequence.camera(), make_extractor(options.features, options.extractor), options);
  if (mode == "localization") system.load_map(std::move(map), {});
  EndlessWalk walk(sequence, system);
  const std::size_t before = walk.heap_after(settings.first);
  const std::size_t after = walk.heap_after(settings.frames);
  system.finish();
  const double growth = static_cast<double>(after) - static_cast<double>(before);
  const double frames = static_cast<double>(settings.frames - settings.first);
  fmt::print("| {} | {} | {} | {} | {:.1f} | {:.1f} | {:+.1f} % | {:.0f} |\n", mode,
             options.features, system.map().keyframe_count(), system.map().point_count(),
             mib(before), mib(after), 100.0 * growth / static_cast<double>(before),
             growth / frames);
  std::fflush(stdout);
}

int run(const Settings& settings) {
  mallopt(M_ARENA_MAX, 1);  // mallinfo2 counts the first arena only
  const auto sequence = open_sequence(settings.sequence);
  fmt::print(
      "| mode | features | keyframes | points | heap after {} frames, MiB | after {} | growth | "
      "bytes per frame |\n|---|---|---|---|---|---|---|---|\n",
      settings.first, settings.frames);
  for (const std::string& mode : settings.modes) measure(settings, *sequence, mode);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Heap in use after some and after many frames of one place");
  Settings settings;
  app.add_option("SEQUENCE", settings.sequence, "A short recording, walked again and again")
      ->required();
  app.add_option("--features", settings.features, "Extractor name or model manifest");
  app.add_option("--modes", settings.modes, "slam, localization")->delimiter(',');
  app.add_option("--first", settings.first, "Frames before the first measurement");
  app.add_option("--frames", settings.frames, "Frames before the second");
  app.add_flag("--deterministic", settings.deterministic, "One thread");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(settings);
  } catch (const std::exception& error) {
    fmt::print(stderr, "memory_benchmark: {}\n", error.what());
    return 1;
  }
}
