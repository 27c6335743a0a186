// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "apps/command_files.h"
#include "apps/commands.h"
#include "apps/console.h"
#include "apps/open_recording.h"
#include "apps/recording_report.h"
#include "io/primitives/atomic_file.h"
#include "io/primitives/json_text.h"
#include "io/recordings/recording_info.h"

namespace dxslam::apps {
namespace {

using Json = nlohmann::ordered_json;

struct InfoArguments {
  std::string source;
  SequenceOptions reader;
  std::string json;
};

std::string describe(const StreamTiming& timing) {
  if (timing.rate == 0.0) return "";
  const std::string rate = fmt::format(", {:.1f} per second", timing.rate);
  if (timing.gaps == 0) return rate + ", no gap";
  return rate + fmt::format(", {} gaps, the longest of {:.2f} s", timing.gaps, timing.longest_gap);
}

// What a recording of a camera is made of.
bool is_of_cameras(const TopicInfo& topic) {
  return !topic.content.empty() || topic.type == "sensor_msgs/CameraInfo" ||
         topic.type == "tf2_msgs/TFMessage" || topic.type == "tf/tfMessage";
}

// On one page: all topics of cameras, and others only where they are few.
void print_topics(const std::vector<TopicInfo>& topics) {
  constexpr std::size_t kFew = 15;
  std::size_t others = 0;
  for (const TopicInfo& topic : topics) {
    if (topics.size() > kFew && !is_of_cameras(topic)) {
      ++others;
      continue;
    }
    print("topic {}\n  {}{}{}: {} message{}{}\n", topic.name, topic.type,
          topic.content.empty() ? "" : ", ", topic.content, topic.timing.count,
          topic.timing.count == 1 ? "" : "s", describe(topic.timing));
  }
  if (others > 0) print("and {} topics of other things, which --json lists\n", others);
}

void print_camera(const ImageOrigin& origin) {
  const Camera& c = origin.camera();
  print("calibration from {}\n", origin.facts().calibration_source);
  print("  {}x{}, fx {:.2f}, fy {:.2f}, cx {:.2f}, cy {:.2f}\n", c.width, c.height, c.fx, c.fy,
        c.cx, c.cy);
  if (!c.has_distortion()) return print("  no distortion\n");
  print("  lens {}", c.lens.model->name);
  for (std::size_t i = 0; i < c.lens.model->parameter_count(); ++i) {
    print(", {} {:g}", c.lens.model->parameters[i], c.lens.parameters[i]);
  }
  print("\n");
}

void print_depth(const ImageOrigin& origin) {
  const RecordingFacts& facts = origin.facts();
  if (!facts.has_depth) return;
  print("depth: {:g} raw units per metre", origin.camera().depth_factor);
  if (facts.depth_share == 0.0) return print(", no reading in the first images\n");
  print(", median {:.2f} m in the first images, {:.0f} % of their pixels\n", facts.median_depth,
        100.0 * facts.depth_share);
}

// Whether `dxslam run` can read it.
bool is_usable(const RecordingInfo& info) {
  return info.origin != nullptr && info.origin->facts().has_depth;
}

// What a user may miss of a recording that can be read, one sentence each.
std::vector<std::string> missing_of(const RecordingInfo& info) {
  std::vector<std::string> missing;
  if (!info.origin->facts().has_depth) {
    missing.emplace_back("depth images, which `dxslam run` needs");
  }
  if (!info.left_out.empty()) {
    missing.push_back(fmt::format("{} images were left out; the first: {}", info.left_out.size(),
                                  info.left_out[0].reason));
  }
  const ImageCheck& images = info.images;
  if (images.absent > 0) {
    missing.push_back(fmt::format("{} of {} images are not there; the first: {}", images.absent,
                                  info.frames.count, images.first_absent));
  }
  if (images.damaged > 0) {
    missing.push_back(fmt::format("{} of {} images looked at cannot be used; the first: {}",
                                  images.damaged, images.looked_at, images.first_damaged));
  }
  if (info.dropped > 0) {
    missing.push_back(fmt::format("{} images that came too fast", info.dropped));
  }
  return missing;
}

void print_info(const InfoArguments& arguments, const RecordingInfo& info) {
  const bool is_camera = info.format == "camera";
  print("{}: {}{}\n", arguments.source, is_camera ? "" : "recording of format ", info.format);
  print_topics(info.topics);
  if (info.origin == nullptr) return print("cannot be used: {}\n", info.problem);
  const ImageOrigin& origin = *info.origin;
  print("frames: {}{} depth, {:.1f} s from {:.6f} on{}\n", info.frames.count,
        origin.facts().has_depth ? " with" : " without", info.frames.last - info.frames.first,
        info.frames.first, describe(info.frames));
  print_camera(origin);
  print_depth(origin);
  print("true trajectory: {}\n", origin.ground_truth().empty()
                                     ? "none"
                                     : fmt::format("{} poses", origin.ground_truth().size()));
  for (const std::string& note : origin.facts().notes) print("note: {}\n", note);
  const std::vector<std::string> missing = missing_of(info);
  for (const std::string& what : missing) print("missing: {}\n", what);
  if (missing.empty()) print("missing: nothing\n");
}

Json timing_json(const StreamTiming& timing) {
  return {
      {"count", timing.count}, {"first_s", timing.first},
      {"last_s", timing.last}, {"rate_hz", timing.rate > 0.0 ? Json(timing.rate) : Json(nullptr)},
      {"gaps", timing.gaps},   {"longest_gap_s", timing.longest_gap}};
}

Json info_json(const InfoArguments& arguments, const RecordingInfo& info) {
  Json json{{"source", arguments.source}, {"format", info.format}, {"topics", Json::array()}};
  for (const TopicInfo& topic : info.topics) {
    Json row{{"name", topic.name}, {"type", topic.type}, {"content", topic.content}};
    row.update(timing_json(topic.timing));
    json["topics"].push_back(std::move(row));
  }
  json["usable"] = is_usable(info);
  if (info.origin == nullptr) {
    json["problem"] = info.problem;
    return json;
  }
  json["missing"] = missing_of(info);
  json["frames"] = timing_json(info.frames);
  json["frames"]["with_depth"] = info.origin->facts().has_depth;
  json.update(recording_json(*info.origin));
  json["true_poses"] = info.origin->ground_truth().size();
  json["notes"] = info.origin->facts().notes;
  return json;
}

void tell(const InfoArguments& arguments) {
  CommandFiles({arguments.source})
      .writes("--json", arguments.json,
              json_kind("a description of `dxslam info`", {"source", "format"}));
  const RecordingInfo info = inspect_recording(arguments.source, arguments.reader);
  print_info(arguments, info);
  if (!arguments.json.empty()) {
    write_file_atomically(arguments.json, to_json_text(info_json(arguments, info)));
  }
  if (!is_usable(info)) throw CLI::RuntimeError(kBadInput);
}

}  // namespace

void add_info_command(CLI::App& app) {
  const auto arguments = std::make_shared<InfoArguments>();
  CLI::App* command = app.add_subcommand(
      "info",
      "tell what a recording or camera gives: streams, rates, gaps, calibration, what is missing");
  command->add_option("SOURCE", arguments->source, source_help())->required();
  add_reader_options(*command, arguments->reader);
  command->add_option("--json", arguments->json, "also write it to a JSON file");
  command->callback([arguments] { tell(*arguments); });
}

}  // namespace dxslam::apps
