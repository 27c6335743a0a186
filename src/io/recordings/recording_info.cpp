// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/recordings/recording_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/error.h"
#include "io/bags/bag_file.h"
#include "io/bags/bag_streams.h"
#include "io/recordings/sequence_formats.h"
#include "io/sources/open_source.h"

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

// Whether the file of an image is there; the pictures of a bag are in it.
bool is_there(const std::string& file, const ImageLoader& loader) {
  std::error_code error;
  return file.empty() || loader || std::filesystem::exists(file, error);
}

// Looks for all files; returns the frames whose files are there.
std::vector<std::size_t> look_for_files(const SequenceListing& listing, ImageCheck& images) {
  std::vector<std::size_t> present;
  for (std::size_t i = 0; i < listing.frames.size(); ++i) {
    const ListedFrame& frame = listing.frames[i];
    const bool has_color = is_there(frame.color, listing.load_color);
    if (has_color && is_there(frame.depth, listing.load_depth)) {
      present.push_back(i);
    } else if (images.absent++ == 0) {
      images.first_absent = has_color ? frame.depth : frame.color;
    }
  }
  return present;
}

// Reads some of the frames, evenly.
void read_some(const std::vector<std::size_t>& present, RgbdSequence& sequence,
               ImageCheck& images) {
  constexpr std::size_t kMost = 40;  // half a second
  images.looked_at = std::min(kMost, present.size());
  for (std::size_t i = 0; i < images.looked_at; ++i) {
    const std::size_t frame = present[i * present.size() / images.looked_at];
    if (sequence.read(frame) || images.damaged++ > 0) continue;
    images.first_damaged = sequence.skipped().back().reason;
  }
}

RecordingInfo inspect_camera(const std::string& name, const SequenceOptions& options) {
  constexpr double kLong = 3.0;  // seconds
  std::unique_ptr<ImageSource> source = open_live_source(name, options);
  RecordingInfo info;
  info.format = "camera";
  std::vector<double> stamps;
  while (const std::optional<RgbdImage> image = source->next()) {
    stamps.push_back(image->stamp);
    if (stamps.back() - stamps.front() > kLong) break;
  }
  source->stop();
  info.frames = timing_of(std::move(stamps));
  info.dropped = source->dropped();
  info.left_out = source->skipped();
  info.origin = std::move(source);
  return info;
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
  if (is_live_source(path)) return inspect_camera(path, options);
  RecordingInfo info;
  info.format = recognised_format(path, options.format);
  if (info.format == "bag") info.topics = topics_of(path);
  std::vector<std::size_t> present;
  std::unique_ptr<RgbdSequence> sequence;
  try {
    SequenceListing listing = list_sequence(path, options);
    present = look_for_files(listing, info.images);
    sequence = make_sequence(std::move(listing));
  } catch (const InputError& e) {
    if (info.topics.empty()) throw;
    info.problem = e.what();
    return info;
  }
  std::vector<double> stamps;
  for (std::size_t i = 0; i < sequence->size(); ++i) stamps.push_back(sequence->stamp(i));
  info.frames = timing_of(std::move(stamps));
  info.left_out = sequence->skipped();
  read_some(present, *sequence, info.images);
  info.origin = std::move(sequence);
  return info;
}

}  // namespace dxslam
