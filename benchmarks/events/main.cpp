// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// What readers of the event stream cost: the same recording without one, with one that never reads,
// and with one that reads everything, in turns; all in real threads. Times of a frame and of
// mapping a keyframe, medians over the rounds; they are told in messages too, small ones, which are
// left unread until the end.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "core/error.h"
#include "features/extractor_factory.h"
#include "io/recordings/sequence_reader.h"
#include "slam/run_statistics.h"
#include "slam/system.h"

namespace {

using namespace dxslam;

struct Settings {
  std::string sequence;
  std::string features = "auto";
  int rounds = 5;
};

const std::vector<std::string> kReaders = {"none", "never reads", "reads all"};

struct Times {
  std::vector<double> frame;    // median of a run, ms
  std::vector<double> mapping;  // total of a run, ms
  std::uint64_t messages = 0;
  std::uint64_t lost = 0;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void run_once(const Settings& settings, const std::vector<RgbdImage>& images, const Camera& camera,
              const std::string& kind, Times& times) {
  SystemOptions options;
  options.features = settings.features == "auto" ? choose_extractor().name : settings.features;
  System system(camera, make_extractor(options.features, options.extractor), options);
  const SubscriptionPtr told = system.subscribe(Subscription::kUnbounded, RunStatistics::kinds());
  SubscriptionPtr reader;
  if (kind != "none") reader = system.subscribe();
  std::thread thread;
  if (kind == "reads all") {
    thread = std::thread([&] {
      while (!reader->has_ended()) {
        if (reader->next(std::chrono::milliseconds(100))) ++times.messages;
      }
    });
  }
  for (const RgbdImage& image : images) system.process(image);
  system.finish();
  if (thread.joinable()) thread.join();
  if (reader) times.lost += reader->lost();
  RunStatistics statistics;
  while (const MessagePtr message = told->try_next()) statistics.add(message->event);
  const auto stages = statistics.stages();
  times.frame.push_back(stages.at("frame").median_ms);
  double mapping = 0.0;
  for (const char* stage : {"map_insert", "map_refine", "loop_closing"}) {
    mapping += stages.at(stage).total_ms;
  }
  times.mapping.push_back(mapping);
}

int run(const Settings& settings) {
  const auto sequence = open_sequence(settings.sequence);
  std::vector<RgbdImage> images;
  for (std::size_t i = 0; i < sequence->size(); ++i) {
    if (std::optional<RgbdImage> image = sequence->read(i)) images.push_back(std::move(*image));
  }
  std::map<std::string, Times> times;
  for (int round = 0; round < settings.rounds; ++round) {
    for (const std::string& kind : kReaders) {
      run_once(settings, images, sequence->camera(), kind, times[kind]);
    }
  }
  fmt::print(
      "| reader | frame, ms | of that without | mapping, ms in all | of that without | "
      "messages read, lost |\n|---|---:|---:|---:|---:|---:|\n");
  const double frame = median(times["none"].frame);
  const double mapping = median(times["none"].mapping);
  for (const std::string& kind : kReaders) {
    const Times& t = times[kind];
    fmt::print("| {} | {:.2f} | {:.3f} | {:.0f} | {:.3f} | {}, {} |\n", kind, median(t.frame),
               median(t.frame) / frame, median(t.mapping), median(t.mapping) / mapping, t.messages,
               t.lost);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("What readers of the event stream cost");
  Settings settings;
  app.add_option("SEQUENCE", settings.sequence, "A recording that fits into memory")->required();
  app.add_option("--features", settings.features, "Extractor name or model manifest");
  app.add_option("--rounds", settings.rounds, "Runs with each kind of reader");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(settings);
  } catch (const std::exception& error) {
    fmt::print(stderr, "events_benchmark: {}\n", error.what());
    return 1;
  }
}
