// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// ROS bags and MCAP as recordings: topics and calibration find themselves.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <tuple>

#include "core/error.h"
#include "io/bags/bag_streams.h"
#include "io/bags/realsense_bag.h"
#include "io/bags/ros_picture.h"
#include "io/calibration/calibration.h"
#include "io/calibration/foreign_calibration.h"
#include "io/primitives/limits.h"
#include "io/recordings/inverse_distortion.h"
#include "io/recordings/nearest_in_time.h"
#include "io/recordings/recording_formats.h"
#include "io/recordings/sequence_formats.h"

namespace dxslam {
namespace {

constexpr double kMillimetres = 1000.0;     // of 16UC1, by ROS' convention
constexpr std::size_t kHeaderBytes = 1024;  // of a message: stamp and name of the frame
constexpr double kSameLens = 1e-3;          // share of the focal length

struct StampedEntry {
  double stamp = 0.0;
  BagEntry entry;
};

/// Reads the pictures of the frames; shared by the loaders of the listing.
class BagPictures {
 public:
  BagPictures(std::unique_ptr<BagFile> bag, PictureStream color, std::optional<PictureStream> depth)
      : bag_(std::move(bag)), color_(std::move(color)), depth_(std::move(depth)) {}

  BagFile& bag() { return *bag_; }
  const PictureStream& color() const { return color_; }
  const std::optional<PictureStream>& depth() const { return depth_; }
  void add(const BagEntry& color, const BagEntry& depth) { frames_.emplace_back(color, depth); }

  cv::Mat color_at(std::size_t index, const std::string& name, const ExpectedSize& size) {
    return read_color(bag_->read(frames_.at(index).first), color_, name, size);
  }
  cv::Mat depth_at(std::size_t index, const std::string& name, const ExpectedSize& size) {
    return read_depth(bag_->read(frames_.at(index).second), *depth_, name, size);
  }

 private:
  static cv::Mat read_color(const std::string& bytes, const PictureStream& stream,
                            const std::string& name, const ExpectedSize& size) {
    if (stream.compressed) {
      const RosCompressedImage image = read_ros_compressed_image(bytes, stream.layout, name);
      return decode_color_image(image.data, name, size);
    }
    return color_of(read_ros_image(bytes, stream.layout, name), name, size);
  }

  static cv::Mat read_depth(const std::string& bytes, const PictureStream& stream,
                            const std::string& name, const ExpectedSize& size) {
    if (!stream.compressed) {
      return depth_of(read_ros_image(bytes, stream.layout, name), name, size);
    }
    const RosCompressedImage image = read_ros_compressed_image(bytes, stream.layout, name);
    const CompressedDepth packed = read_compressed_depth(image, name);
    const cv::Mat raw = packed.rvl ? decode_rvl(packed.data, name, size)
                                   : decode_depth_image(packed.data, name, size);
    return packed.inverse ? undo_inverse_depth(raw, packed.scale, packed.shift, name) : raw;
  }

  std::unique_ptr<BagFile> bag_;
  PictureStream color_;
  std::optional<PictureStream> depth_;
  std::vector<std::pair<BagEntry, BagEntry>> frames_;  // colour and depth
};

// By the time at which they were taken, to the microsecond; where the camera says none, at which
// they were recorded.
std::vector<StampedEntry> stamped_entries(BagFile& bag, const PictureStream& stream,
                                          SequenceListing& listing) {
  std::vector<StampedEntry> list;
  std::size_t damaged = 0;
  std::string first_damaged;
  for (const BagEntry& entry : in_file_order(bag, stream.topic)) {
    if (list.size() == limits::kFrames) {
      throw InputError(
          fmt::format("more than {} images of {}, expected less", limits::kFrames, stream.name));
    }
    try {
      const std::string start = bag.read_start(entry, kHeaderBytes);
      const RosHeader header = read_ros_header(start, stream.layout, stream.name);
      const std::int64_t ns = header.stamp_ns > 0 ? header.stamp_ns : entry.recorded_ns;
      list.push_back({static_cast<double>(ns / 1000) / 1e6, entry});
    } catch (const InputError& e) {
      if (damaged++ == 0) first_damaged = e.what();
    }
  }
  if (damaged > 0) {
    listing.notes.push_back(fmt::format("{} images of {} were left out; the first: {}", damaged,
                                        stream.name, first_damaged));
  }
  std::sort(list.begin(), list.end(), [](const StampedEntry& a, const StampedEntry& b) {
    return std::tie(a.stamp, a.entry.recorded_ns) < std::tie(b.stamp, b.entry.recorded_ns);
  });
  return list;
}

std::string name_at(const PictureStream& stream, double stamp) {
  return fmt::format("{} at {:.6f}", stream.name, stamp);
}

void skip(const PictureStream& stream, double stamp, const std::string& why,
          SequenceListing& listing) {
  listing.skipped.push_back(
      {listing.frames.size(), fmt::format("{}: {}", name_at(stream, stamp), why)});
}

void pair_streams(BagPictures& pictures, const SequenceOptions& options, SequenceListing& listing) {
  const PictureStream& color_stream = pictures.color();
  const auto colors = stamped_entries(pictures.bag(), color_stream, listing);
  std::vector<StampedEntry> depths;
  if (pictures.depth()) depths = stamped_entries(pictures.bag(), *pictures.depth(), listing);
  for (const StampedEntry& color : colors) {
    if (!listing.frames.empty() && color.stamp <= listing.frames.back().stamp) {
      skip(color_stream, color.stamp, "the stamp was given before", listing);
      continue;
    }
    ListedFrame frame{color.stamp, name_at(color_stream, color.stamp), ""};
    StampedEntry depth;
    if (pictures.depth()) {
      const auto nearest = nearest_in_time(depths, color.stamp);
      if (nearest == depths.end() ||
          std::abs(nearest->stamp - color.stamp) > options.max_association_s) {
        skip(color_stream, color.stamp,
             fmt::format("no depth image within {} s", options.max_association_s), listing);
        continue;
      }
      depth = *nearest;
      frame.depth = name_at(*pictures.depth(), depth.stamp);
    }
    listing.frames.push_back(std::move(frame));
    pictures.add(color.entry, depth.entry);
  }
  if (!listing.frames.empty()) return;
  throw InputError(fmt::format(
      "no image of {} has one of {} within {} s, expected streams of one camera", color_stream.name,
      pictures.depth() ? pictures.depth()->name : "depth", options.max_association_s));
}

constexpr double kWorstInverse = 0.5;  // pixels

// The camera of the image as it is on the topic: raw, or rectified where its name says so.
Camera camera_of(const FoundCameraInfo& found, const PictureStream& stream, bool inverse = false) {
  const RosCameraInfo& info = found.info;
  const bool rectified = says_rectified(stream) && info.p[0] > 0.0;
  Camera camera;
  camera.width = static_cast<int>(std::min(info.width, limits::kImageSide + 1));
  camera.height = static_cast<int>(std::min(info.height, limits::kImageSide + 1));
  camera.fx = rectified ? info.p[0] : info.k[0];
  camera.cx = rectified ? info.p[2] : info.k[2];
  camera.fy = rectified ? info.p[5] : info.k[4];
  camera.cy = rectified ? info.p[6] : info.k[5];
  camera.depth_factor = kMillimetres;
  if (rectified) return camera;
  const std::vector<double> d(info.d.begin(), info.d.end());
  if (!inverse) {
    camera.lens = lens_from_ros(info.distortion_model, d, found.topic);
    return camera;
  }
  std::array<double, 5> coefficients{};
  std::copy_n(d.begin(), std::min(d.size(), coefficients.size()), coefficients.begin());
  camera.prepare(found.topic);  // divides by the focal lengths
  const double error = set_inverse_distortion(coefficients, camera);
  if (!(error < kWorstInverse)) {
    throw InputError(fmt::format(
        "{}: its distortion the other way round is {:.1f} pixels off, expected less than {:g}; "
        "--calibration gives another",
        found.topic, error, kWorstInverse));
  }
  return camera;
}

double median_rate(const std::vector<ListedFrame>& frames) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    steps.push_back(frames[i].stamp - frames[i - 1].stamp);
  }
  if (steps.empty()) return Camera().fps;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return std::clamp(1.0 / *middle, 1e-3, 1e4);
}

DepthCamera depth_camera_of(const Camera& lens, const SE3& color_from_depth) {
  const Eigen::Vector3d t = color_from_depth.translation();
  const Eigen::Vector3d r = so3_log(color_from_depth.rotation());
  DepthCamera depth;
  depth.width = lens.width;
  depth.height = lens.height;
  depth.fx = lens.fx;
  depth.fy = lens.fy;
  depth.cx = lens.cx;
  depth.cy = lens.cy;
  depth.x = t.x();
  depth.y = t.y();
  depth.z = t.z();
  depth.rx = r.x();
  depth.ry = r.y();
  depth.rz = r.z();
  depth.lens = lens.lens;
  return depth;
}

bool same_lens(const Camera& a, const Camera& b) {
  return a.width == b.width && a.height == b.height && std::abs(a.fx - b.fx) < kSameLens * b.fx &&
         std::abs(a.cx - b.cx) < kSameLens * b.fx;
}

// Depth of another camera than colour, or of another size, is registered by what the bag says.
void register_depth(BagPictures& pictures, SequenceListing& listing) {
  const PictureStream& color = pictures.color();
  const PictureStream& depth = *pictures.depth();
  const bool registered = says_registered(depth, color);
  const cv::Size color_size(listing.camera.width, listing.camera.height);
  if (registered && depth.size == color_size) return;
  const auto found = camera_info_of(pictures.bag(), depth);
  if (!found) {
    if (depth.size.empty() || depth.size == color_size) {
      if (!registered) {
        listing.notes.push_back(
            fmt::format("{} is taken to be registered to {}: the bag has no camera_info for it",
                        depth.name, color.name));
      }
      return;
    }
    throw InputError(fmt::format(
        "{} has {}x{} pixels, {} has {}x{}, and no camera_info is for the former, expected "
        "depth registered to colour or --calibration with a depth_camera",
        depth.name, depth.size.width, depth.size.height, color.name, color_size.width,
        color_size.height));
  }
  const std::string own = realsense_stream(depth.name);
  const bool inverse = !own.empty() && has_inverse_distortion(pictures.bag(), own);
  Camera lens = camera_of(*found, depth, inverse);
  if (registered) {
    if (!same_lens(lens, listing.camera)) {
      lens.prepare(found->topic);
      use_depth_camera(depth_camera_of(lens, SE3()), listing);
    }
    return;
  }
  auto color_from_depth = realsense_transform(pictures.bag(), realsense_stream(color.name),
                                              realsense_stream(depth.name));
  if (!color_from_depth) {
    color_from_depth = find_transform(pictures.bag(), color.frame, depth.frame);
  }
  if (!color_from_depth) {
    if (same_lens(lens, listing.camera)) return;
    throw InputError(fmt::format(
        "{} is of another camera than {} and no transform ties frame {} to {}, expected depth "
        "registered to colour or --calibration with a depth_camera",
        depth.name, color.name, depth.frame, color.frame));
  }
  lens.prepare(found->topic);
  use_depth_camera(depth_camera_of(lens, *color_from_depth), listing);
}

// What `dxslam record` wrote beside the images: more than a camera_info can say.
bool use_own_calibration(BagPictures& pictures, SequenceListing& listing) {
  BagFile& bag = pictures.bag();
  for (const BagEntry& entry : bag.entries()) {
    const BagTopic& topic = bag.topics()[entry.topic];
    if (topic.name != kCalibrationTopic || topic.type != "std_msgs/String") continue;
    const std::string text = read_ros_string(bag.read(entry), topic.encoding, topic.name);
    listing.camera = parse_camera(text, topic.name);
    listing.calibration_source = topic.name;
    return true;
  }
  return false;
}

void find_calibration(BagPictures& pictures, const std::string& path,
                      const SequenceOptions& options, SequenceListing& listing) {
  if (!use_explicit_calibration(path, options, listing) &&
      !use_own_calibration(pictures, listing)) {
    const auto found = camera_info_of(pictures.bag(), pictures.color());
    const std::string realsense = realsense_stream(pictures.color().name);
    if (!found && (options.needs_calibration || pictures.color().size.empty())) {
      throw InputError(fmt::format(
          "{}: no calibration: the bag has no camera_info beside {}, expected --calibration with "
          "a preset or a YAML file",
          path, pictures.color().name));
    }
    listing.calibration_source = found ? found->topic : "no file";
    const bool inverse = !realsense.empty() && has_inverse_distortion(pictures.bag(), realsense);
    listing.camera = found ? camera_of(*found, pictures.color(), inverse)
                           : made_up_camera(pictures.color().size);
    const auto factor =
        pictures.depth()
            ? realsense_depth_factor(pictures.bag(), realsense_stream(pictures.depth()->name))
            : std::nullopt;
    if (factor) listing.camera.depth_factor = *factor;
    listing.camera.fps = median_rate(listing.frames);
    listing.camera.prepare(listing.calibration_source);
  }
  if (pictures.depth() && !listing.register_depth) register_depth(pictures, listing);
}

void note_choice(const std::vector<PictureStream>& streams, const BagPictures& pictures,
                 const SequenceOptions& options, SequenceListing& listing) {
  const std::size_t used = pictures.depth() ? 2 : 1;
  const bool named = !options.color_topic.empty() && (!options.depth_topic.empty() || used == 1);
  if (named || streams.size() <= used) return;
  listing.notes.push_back(fmt::format(
      "of {} topics of pictures, {} is colour and {} depth; --color-topic and --depth-topic say "
      "others",
      streams.size(), pictures.color().name, pictures.depth() ? pictures.depth()->name : "none"));
}

SequenceListing list_topics(const std::string& path, std::unique_ptr<BagFile> bag,
                            const SequenceOptions& options) {
  const std::vector<PictureStream> streams = find_picture_streams(*bag);
  const PictureStream color = choose_color(streams, options.color_topic, path);
  const auto depth = choose_depth(streams, color, options.depth_topic, path);
  SequenceListing listing;
  listing.name = folder_name(path);
  listing.notes = bag->notes();
  const auto pictures = std::make_shared<BagPictures>(std::move(bag), color, depth);
  note_choice(streams, *pictures, options, listing);
  pair_streams(*pictures, options, listing);
  find_calibration(*pictures, path, options, listing);
  listing.load_color = [pictures](std::size_t index, const ListedFrame& frame,
                                  const ExpectedSize& size) {
    return pictures->color_at(index, frame.color, size);
  };
  listing.load_depth = [pictures](std::size_t index, const ListedFrame& frame,
                                  const ExpectedSize& size) {
    return pictures->depth_at(index, frame.depth, size);
  };
  return listing;
}

}  // namespace

SequenceListing list_bag(const std::string& path, const SequenceOptions& options) {
  std::unique_ptr<BagFile> bag = open_bag(path);
  try {
    return list_topics(path, std::move(bag), options);
  } catch (const InputError& e) {  // what is inside knows its topic, but not the file
    const std::string sentence = e.what();
    const std::string& calibration = options.calibration;
    const bool names_file =
        sentence.starts_with(path) || (!calibration.empty() && sentence.starts_with(calibration));
    throw InputError(names_file ? sentence : fmt::format("{}: {}", path, sentence));
  }
}

}  // namespace dxslam
