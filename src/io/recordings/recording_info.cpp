// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/recordings/recording_info.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "io/bags/bag_file.h"
#include "io/bags/bag_streams.h"

namespace dxslam {
namespace {

constexpr double kGap = 1.5;  // times the usual step: at least one message is missing

std::vector<TopicInfo> topics_of(const std::string& path) {
  const std::unique_ptr<BagFile> bag = open_bag(path);
  std::vector<TopicInfo> topics(bag->topics().size());
  std::vector<std::vector<double>> stamps(topics.size());
  for (const BagEntry& entry : bag->entries()) {
    stamps[entry.topic].push_back(static_cast<double>(entry.recorded_ns) * 1e-9);
  }
  for (std::size_t i = 0; i < topics.size(); ++i) {
    topics[i] = {bag->topics()[i].name, bag->topics()[i].type, "", timing_of(std::move(stamps[i]))};
  }
  for (const PictureStream& stream : find_picture_streams(*bag)) {
    topics[stream.topic].content =
        stream.compressed
            ? stream.encoding
            : fmt::format("{} {}x{}", stream.encoding, stream.size.width, stream.size.height);
  }
  std::sort(topics.begin(), topics.end(),
            [](const TopicInfo& a, const TopicInfo& b) { return a.name < b.name; });
  return topics;
}

}  // namespace

StreamTiming timing_of(std::vector<double> stamps) {
  StreamTiming timing;
  timing.count = stamps.size();
  if (stamps.empty()) return timing;
  std::sort(stamps.begin(), stamps.end());
  timing.first = stamps.front();
  timing.last = stamps.back();
  std::vector<double> steps;
  for (std::size_t i = 1; i < stamps.size(); ++i) steps.push_back(stamps[i] - stamps[i - 1]);
  if (steps.empty()) return timing;
  std::sort(steps.begin(), steps.end());
  const double usual = steps[steps.size() / 2];
  if (!(usual > 0.0)) return timing;  // several at one time
  timing.rate = 1.0 / usual;
  const auto first_gap = std::upper_bound(steps.begin(), steps.end(), kGap * usual);
  timing.gaps = static_cast<std::size_t>(steps.end() - first_gap);
  if (timing.gaps > 0) timing.longest_gap = steps.back();
  return timing;
}

RecordingInfo inspect_recording(const std::string& path, const SequenceOptions& options) {
  RecordingInfo info;
  info.format = recognised_format(path, options.format);
  if (info.format == "bag") info.topics = topics_of(path);
  try {
    info.sequence = open_sequence(path, options);
  } catch (const InputError& e) {
    if (info.topics.empty()) throw;
    info.problem = e.what();
    return info;
  }
  std::vector<double> stamps;
  for (std::size_t i = 0; i < info.sequence->size(); ++i) {
    stamps.push_back(info.sequence->stamp(i));
  }
  info.frames = timing_of(std::move(stamps));
  return info;
}

}  // namespace dxslam
