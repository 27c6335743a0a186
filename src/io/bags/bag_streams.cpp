// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/bags/bag_streams.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <iterator>
#include <map>
#include <tuple>

#include "core/error.h"
#include "io/bags/realsense_bag.h"
#include "io/primitives/limits.h"
#include "io/primitives/text_file.h"

namespace dxslam {
namespace {

bool contains(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}
bool begins_with(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

bool is_depth_encoding(const std::string& encoding, const std::string& name) {
  if (begins_with(encoding, "16UC1") || begins_with(encoding, "32FC1")) return true;
  if (begins_with(encoding, "mono16")) return contains(name, "epth");
  return contains(encoding, "compressedDepth") || contains(name, "compressedDepth");
}

std::vector<std::string> parts_of(const std::string& topic) {
  std::vector<std::string> parts;
  std::size_t at = 0;
  while (at < topic.size()) {
    const std::size_t end = std::min(topic.find('/', at), topic.size());
    if (end > at) parts.push_back(topic.substr(at, end - at));
    at = end + 1;
  }
  return parts;
}

std::size_t shared_parts(const std::string& a, const std::string& b) {
  const std::vector<std::string> left = parts_of(a);
  const std::vector<std::string> right = parts_of(b);
  std::size_t n = 0;
  while (n < left.size() && n < right.size() && left[n] == right[n]) ++n;
  return n;
}

std::string parent_of(const std::string& topic) {
  return topic.substr(0, std::min(topic.rfind('/'), topic.size()));
}

// The topic that all transports of one image have in common.
std::string base_topic(const std::string& topic) {
  for (const char* transport : {"/compressed", "/compressedDepth"}) {
    const std::string ending = transport;
    if (topic.size() > ending.size() &&
        topic.compare(topic.size() - ending.size(), ending.size(), ending) == 0) {
      return topic.substr(0, topic.size() - ending.size());
    }
  }
  return topic;
}

std::string frame_name(std::string frame) {
  frame.erase(0, std::min(frame.find_first_not_of('/'), frame.size()));
  return frame;
}

// How likely a stream is the colour, or the depth, of an RGB-D camera; more is likelier.
int color_rank(const PictureStream& stream) {
  int rank = 0;
  if (contains(stream.name, "olor") || contains(stream.name, "rgb")) rank += 8;
  if (contains(stream.name, "infra") || contains(stream.name, "fisheye")) rank -= 8;
  if (contains(stream.name, "epth")) rank -= 4;
  if (says_rectified(stream)) rank += 2;
  if (stream.compressed) rank -= 1;
  return rank;
}

std::string list_names(const std::vector<PictureStream>& streams) {
  std::string names;
  for (const PictureStream& s : streams) {
    names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", in_quotes(s.name),
                         in_quotes(s.encoding));
  }
  return names.empty() ? "no pictures at all" : names;
}

PictureStream stream_named(const std::vector<PictureStream>& streams, const std::string& name,
                           const std::string& where) {
  const auto found = std::find_if(streams.begin(), streams.end(),
                                  [&](const PictureStream& s) { return s.name == name; });
  if (found != streams.end()) return *found;
  throw InputError(fmt::format("{}: no topic of pictures {}, there is {}", where, in_quotes(name),
                               list_names(streams)));
}

PictureStream stream_of(const std::string& message, const BagTopic& topic, std::uint32_t index) {
  PictureStream stream;
  stream.topic = index;
  stream.name = topic.name;
  stream.layout = topic.encoding;
  stream.messages = topic.messages;
  stream.compressed = topic.type == "sensor_msgs/CompressedImage";
  RosHeader header;
  if (stream.compressed) {
    const RosCompressedImage image = read_ros_compressed_image(message, topic.encoding, topic.name);
    stream.encoding = image.format;
    header = image.header;
  } else {
    const RosImage image = read_ros_image(message, topic.encoding, topic.name);
    stream.encoding = image.encoding;
    stream.size = {static_cast<int>(std::min(image.width, limits::kImageSide + 1)),
                   static_cast<int>(std::min(image.height, limits::kImageSide + 1))};
    header = image.header;
  }
  // There the name is a kind of clock.
  const std::string realsense = realsense_stream(stream.name);
  const bool is_clock = !realsense.empty() && header.frame.size() <= 1;
  stream.frame = frame_name(is_clock ? realsense : header.frame);
  stream.depth = is_depth_encoding(stream.encoding, stream.name);
  return stream;
}

// a_from_b of all that the topics of transforms, static ones or others, say.
using Transforms = std::map<std::string, std::map<std::string, SE3>>;

void add_transforms(const std::vector<RosTransform>& transforms, Transforms& edges) {
  for (const RosTransform& t : transforms) {
    const std::string parent = frame_name(t.parent);
    const std::string child = frame_name(t.child);
    edges[parent].try_emplace(child, t.parent_from_child);
    edges[child].try_emplace(parent, t.parent_from_child.inverse());
  }
}

void read_transforms(BagFile& bag, bool of_static, Transforms& edges) {
  for (std::uint32_t i = 0; i < bag.topics().size(); ++i) {
    const BagTopic& topic = bag.topics()[i];
    if (topic.type != "tf2_msgs/TFMessage" && topic.type != "tf/tfMessage") continue;
    if (contains(topic.name, "static") != of_static) continue;
    for (const BagEntry& entry : in_file_order(bag, i)) {
      try {
        add_transforms(read_ros_transforms(bag.read(entry), topic.encoding, topic.name), edges);
      } catch (const InputError&) {
        continue;
      }
    }
  }
}

std::optional<SE3> connect(const Transforms& edges, const std::string& to,
                           const std::string& from) {
  std::map<std::string, SE3> known{{to, SE3()}};  // `to` from each
  std::deque<std::string> todo{to};
  while (!todo.empty() && known.count(from) == 0) {
    const std::string frame = todo.front();
    todo.pop_front();
    const auto neighbours = edges.find(frame);
    if (neighbours == edges.end()) continue;
    for (const auto& [next, frame_from_next] : neighbours->second) {
      if (known.emplace(next, known.at(frame) * frame_from_next).second) todo.push_back(next);
    }
  }
  const auto found = known.find(from);
  return found == known.end() ? std::nullopt : std::optional<SE3>(found->second);
}

}  // namespace

std::vector<PictureStream> find_picture_streams(BagFile& bag) {
  std::map<std::uint32_t, PictureStream> found;
  for (const BagEntry& entry : bag.entries()) {
    const BagTopic& topic = bag.topics()[entry.topic];
    if (topic.type != "sensor_msgs/CompressedImage" && topic.type != "sensor_msgs/Image") continue;
    if (found.count(entry.topic) != 0) continue;
    try {
      found.emplace(entry.topic, stream_of(bag.read(entry), topic, entry.topic));
    } catch (const InputError&) {
      continue;  // the next message may be whole
    }
  }
  std::vector<PictureStream> streams;
  for (auto& [topic, stream] : found) streams.push_back(std::move(stream));
  return streams;
}

std::vector<BagEntry> in_file_order(const BagFile& bag, std::uint32_t topic) {
  std::vector<BagEntry> entries;
  std::copy_if(bag.entries().begin(), bag.entries().end(), std::back_inserter(entries),
               [&](const BagEntry& entry) { return entry.topic == topic; });
  std::sort(entries.begin(), entries.end(), [](const BagEntry& a, const BagEntry& b) {
    return std::tie(a.part, a.chunk, a.offset) < std::tie(b.part, b.chunk, b.offset);
  });
  return entries;
}

PictureStream choose_color(const std::vector<PictureStream>& streams, const std::string& wanted,
                           const std::string& where) {
  if (!wanted.empty()) return stream_named(streams, wanted, where);
  const PictureStream* best = nullptr;
  const auto rank = [](const PictureStream& s) { return std::tuple(color_rank(s), s.messages); };
  for (const PictureStream& s : streams) {
    if (!s.depth && (best == nullptr || rank(s) > rank(*best))) best = &s;
  }
  if (best != nullptr) return *best;
  throw InputError(
      fmt::format("{}: no colour images in it, there is {}", where, list_names(streams)));
}

std::optional<PictureStream> choose_depth(const std::vector<PictureStream>& streams,
                                          const PictureStream& color, const std::string& wanted,
                                          const std::string& where) {
  if (!wanted.empty()) return stream_named(streams, wanted, where);
  const PictureStream* best = nullptr;
  const auto rank = [&](const PictureStream& s) {
    return std::tuple(shared_parts(s.name, color.name), says_registered(s, color), !s.compressed,
                      s.messages);
  };
  for (const PictureStream& s : streams) {
    if (s.depth && (best == nullptr || rank(s) > rank(*best))) best = &s;
  }
  return best == nullptr ? std::nullopt : std::optional<PictureStream>(*best);
}

std::optional<FoundCameraInfo> camera_info_of(BagFile& bag, const PictureStream& stream) {
  std::optional<FoundCameraInfo> of_same_frame;
  const std::string beside = parent_of(base_topic(stream.name));
  const std::string realsense = realsense_stream(stream.name);
  std::vector<bool> seen(bag.topics().size(), false);
  for (const BagEntry& entry : bag.entries()) {
    const BagTopic& topic = bag.topics()[entry.topic];
    if (topic.type != "sensor_msgs/CameraInfo" || seen[entry.topic]) continue;
    try {
      FoundCameraInfo found{topic.name,
                            read_ros_camera_info(bag.read(entry), topic.encoding, topic.name)};
      if (!(found.info.k[0] > 0.0)) continue;  // of a camera that was not calibrated
      seen[entry.topic] = true;
      if (parent_of(topic.name) == beside) return found;
      if (!realsense.empty() && topic.name == realsense + "/info/camera_info") return found;
      const bool same_frame =
          !stream.frame.empty() && frame_name(found.info.header.frame) == stream.frame;
      if (same_frame && !of_same_frame) of_same_frame = std::move(found);
    } catch (const InputError&) {
      continue;
    }
  }
  return of_same_frame;
}

bool says_rectified(const PictureStream& stream) {
  const std::string base = base_topic(stream.name);
  return contains(base.substr(parent_of(base).size()), "rect");
}

bool says_registered(const PictureStream& depth, const PictureStream& color) {
  return contains(depth.name, "aligned") || contains(depth.name, "registered") ||
         (!depth.frame.empty() && depth.frame == color.frame);
}

std::optional<SE3> find_transform(BagFile& bag, const std::string& to_frame,
                                  const std::string& from_frame) {
  Transforms edges;
  for (const bool of_static : {true, false}) {
    read_transforms(bag, of_static, edges);
    const auto found = connect(edges, frame_name(to_frame), frame_name(from_frame));
    if (found) return found;
  }
  return std::nullopt;
}

}  // namespace dxslam
