// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "apps/console.h"
#include "apps/features_arguments.h"
#include "apps/open_recording.h"
#include "apps/process.h"
#include "apps/usage.h"
#include "core/error.h"
#include "features/extractor_factory.h"
#include "io/primitives/atomic_file.h"
#include "io/primitives/json_text.h"
#include "io/recordings/sequence_reader.h"

namespace dxslam::apps {
namespace {

/// The reference that times are read against: ORB as OpenCV has it, 1000 features, 8 levels.
constexpr const char* kReference = "opencv_orb";
/// Runs of each extractor before the clock counts: compilation, caches, clock frequency.
constexpr std::size_t kWarmUp = 3;

struct BenchArguments {
  std::string sequence;
  SequenceOptions reader;
  std::string json;
  std::vector<std::string> features;
  ExtractorOptions options;
  int frames = 50;
  double low_light = 0.0;
};

/// One row of the table: an extractor with or without its global descriptor.
struct Contestant {
  std::string name;
  bool with_global = false;
  std::shared_ptr<FeatureExtractor> extractor;
  std::vector<double> totals;                                       // ms, a frame
  std::vector<std::pair<std::string, std::vector<double>>> stages;  // ms, a frame
};

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

std::vector<cv::Mat> read_frames(const BenchArguments& arguments) {
  const auto sequence = open_recording(arguments.sequence, arguments.reader);
  const std::size_t count = std::min(sequence->size(), static_cast<std::size_t>(arguments.frames));
  std::vector<cv::Mat> frames;
  for (std::size_t i = 0; i < count; ++i) {
    const auto image = sequence->read(i * sequence->size() / count);
    if (!image) continue;
    frames.push_back(arguments.low_light > 0.0
                         ? LowLight(arguments.low_light).apply(image->color, image->index)
                         : image->color);
  }
  if (frames.empty()) {
    throw InputError(
        fmt::format("{}: no frame could be read, expected at least one", arguments.sequence));
  }
  return frames;
}

std::vector<Contestant> make_contestants(const BenchArguments& arguments) {
  std::vector<std::string> names = arguments.features;
  if (names.empty()) names = available_extractors();
  if (std::find(names.begin(), names.end(), kReference) == names.end()) {
    names.insert(names.begin(), kReference);
  }
  std::vector<Contestant> contestants;
  for (const std::string& name : names) {
    const std::shared_ptr<FeatureExtractor> extractor =
        dxslam::make_extractor(name, arguments.options);
    contestants.push_back({extractor->name(), false, extractor, {}, {}});
    if (extractor->traits().global_dimension > 0) {
      contestants.push_back({extractor->name() + " with global", true, extractor, {}, {}});
    }
  }
  return contestants;
}

void run_once(Contestant& contestant, const cv::Mat& frame, bool counts) {
  const auto start = std::chrono::steady_clock::now();
  contestant.extractor->extract(frame, contestant.with_global);
  const std::chrono::duration<double, std::milli> elapsed =
      std::chrono::steady_clock::now() - start;
  if (!counts) return;
  contestant.totals.push_back(elapsed.count());
  for (const StageTime& stage : contestant.extractor->last_stages()) {
    auto found = std::find_if(contestant.stages.begin(), contestant.stages.end(),
                              [&](const auto& entry) { return entry.first == stage.name; });
    if (found == contestant.stages.end()) {
      found = contestant.stages.insert(found, {stage.name, {}});
    }
    found->second.push_back(stage.ms);
  }
}

/// Frame by frame, until the stop, through all contestants, each frame beginning with another one,
/// so that whatever else the machine does meets all alike. Returns the frames done.
std::size_t run_interleaved(const std::vector<cv::Mat>& frames,
                            std::vector<Contestant>& contestants) {
  for (Contestant& contestant : contestants) {
    for (std::size_t i = 0; i < kWarmUp && !stop_requested(); ++i) {
      run_once(contestant, frames[i % frames.size()], false);
    }
  }
  std::size_t done = 0;
  for (; done < frames.size() && !stop_requested(); ++done) {
    for (std::size_t c = 0; c < contestants.size(); ++c) {
      run_once(contestants[(done + c) % contestants.size()], frames[done], true);
    }
  }
  return done;
}

void print_table(const std::vector<Contestant>& contestants, std::size_t frames, int threads) {
  double reference = 0.0;
  for (const Contestant& c : contestants) {
    if (c.name == kReference) reference = percentile(c.totals, 0.5);
  }
  print("{} frames, {} threads, ms per image\n", frames, threads);
  print("{:<28} {:>5} {:>8} {:>8} {:>6}  {}\n", "features", "", "median", "p95", "x ORB",
        "medians of the stages");
  for (const Contestant& c : contestants) {
    const double median = percentile(c.totals, 0.5);
    std::string stages;
    for (const auto& [name, times] : c.stages) {
      stages += fmt::format("{} {:.2f}  ", name, percentile(times, 0.5));
    }
    print("{:<28} {:>5} {:>8.2f} {:>8.2f} {:>6.2f}  {}\n", c.name, c.extractor->precision(), median,
          percentile(c.totals, 0.95), median / reference, stages);
  }
}

nlohmann::ordered_json to_json(const std::vector<Contestant>& contestants, int threads) {
  auto list = nlohmann::ordered_json::array();
  for (const Contestant& c : contestants) {
    auto stages = nlohmann::ordered_json::object();
    for (const auto& [name, times] : c.stages) stages[name] = percentile(times, 0.5);
    list.push_back({{"name", c.name},
                    {"precision", c.extractor->precision()},
                    {"threads", threads},
                    {"median_ms", percentile(c.totals, 0.5)},
                    {"p95_ms", percentile(c.totals, 0.95)},
                    {"stages", stages}});
  }
  return list;
}

void bench(const BenchArguments& arguments) {
  CommandFiles({arguments.sequence})
      .writes("--json", arguments.json,
              json_kind("a table of `dxslam bench`", {"name", "precision"}));
  cv::setNumThreads(arguments.options.threads);
  const auto frames = read_frames(arguments);
  auto contestants = make_contestants(arguments);
  const Unsaved unsaved;
  const std::size_t done = run_interleaved(frames, contestants);
  if (done == 0) return;
  print_table(contestants, done, arguments.options.threads);
  if (!arguments.json.empty()) {
    write_file_atomically(arguments.json,
                          to_json_text(to_json(contestants, arguments.options.threads)));
  }
}

}  // namespace

void add_bench_command(CLI::App& app) {
  auto arguments = std::make_shared<BenchArguments>();
  CLI::App* group = app.add_subcommand("bench", "measure parts of the system");
  group->require_subcommand(1);
  CLI::App* command = group->add_subcommand(
      "features", "time extractors on a recording, interleaved, OpenCV's ORB as the reference");
  command->add_option("sequence", arguments->sequence, "recording, see `dxslam run`")->required();
  add_reader_options(*command, arguments->reader);
  command->add_option("--json", arguments->json, "file for the figures");
  command
      ->add_option("--features", arguments->features,
                   "names or manifests, separated by commas (default: all whose files are there)")
      ->delimiter(',')
      ->check(extractor_name());
  command->add_option("--frames", arguments->frames, "frames, evenly over the recording")
      ->check(whole_number(1, 100000))
      ->capture_default_str();
  command->add_option("--threads", arguments->options.threads, "threads, for all alike")
      ->check(range_of<ExtractorOptions>("threads"))
      ->capture_default_str();
  command->add_option("--precision", arguments->options.precision, "auto, f32, bf16 or int8")
      ->check(precision_name())
      ->capture_default_str();
  add_low_light_option(*command, arguments->low_light);
  command->callback([arguments] { bench(*arguments); });
}

}  // namespace dxslam::apps
