// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "map_files/map_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace dxslam {
namespace {

constexpr int kLargestDimension = 65536;
constexpr float kLargestDistance = 1e6F;  // of descriptors
constexpr double kLatestStamp = 1e20;     // seconds; also of stamps that are nanoseconds
constexpr std::int64_t kLastIndex = std::int64_t{1} << 53;
constexpr std::uint32_t kMostTimes = 0x7FFFFFFFU;  // that a point was looked for
constexpr double kMargin = 4.0;                    // of the image's size, around it
constexpr float kNearestReading = 1e-4F;           // metres
constexpr float kFarthestReading = 2e4F;           // metres; a camera's max_depth is less
constexpr float kLargestScore = 1e9F;
constexpr float kSmallestSigma = 1e-3F;  // pixels
constexpr float kLargestSigma = 1e4F;    // pixels
constexpr float kLongestDescriptor = 2.0F;
constexpr std::size_t kFreePairs = std::size_t{1} << 22;  // of covisible keyframes, both directions
constexpr std::size_t kPairsAnObservation = 64;

// Without early ends, so that it vectorises; false where one is not a number.
template <class Fits>
bool all_of(const std::vector<float>& values, const Fits& fits) {
  bool good = true;
  for (const float value : values) good &= fits(value);
  return good;
}

bool are_possible_lengths(const Frame& f) {
  const std::size_t n = f.size();
  return f.depths.size() == n && f.scores.size() == n && f.sigmas.size() == n &&
         f.descriptors.rows == static_cast<int>(n);
}

void check_frame(const Keyframe& k, const MapHeader& header, const Rig& rig,
                 const std::string& where) {
  const auto expect = [&](bool possible, const char* what) {
    if (possible) return;
    throw InputError(fmt::format(
        "{}: the map is not saved: impossible numbers in {} of keyframe {}", where, what, k.id));
  };
  const Frame& f = *k.frame;
  require(are_possible_lengths(f),
          "a frame to be saved needs as many depths, scores, sigmas and descriptors as keypoints");
  expect(is_possible_index(f.index) && is_possible_stamp(f.stamp), "index or stamp");
  expect(is_possible(k.world_from_camera), "the pose");
  expect(are_possible_keypoints(f, rig[f.camera]), "the keypoints");
  if (!header.traits.binary && f.descriptors.type() == CV_32FC1) {
    expect(f.descriptors.isContinuous() &&
               are_possible_descriptors(f.descriptors.ptr<float>(), f.size(),
                                        static_cast<std::size_t>(f.descriptors.cols)),
           "the descriptors");
  }
  expect(are_possible_descriptors(f.global.data(), 1, f.global.size()), "the global descriptor");
}

}  // namespace

bool is_possible_text(const std::string& text) {
  return text.size() <= kLongestMapText && std::all_of(text.begin(), text.end(), [](char c) {
           const auto byte = static_cast<unsigned char>(c);
           return byte >= 0x20 && byte != 0x7F;
         });
}

bool is_possible(const DescriptorTraits& traits) {
  return traits.dimension >= 1 && traits.dimension <= kLargestDimension &&
         traits.global_dimension >= 0 && traits.global_dimension <= kLargestDimension &&
         traits.max_distance >= 0.0F && traits.max_distance <= kLargestDistance;
}

bool is_possible_index(std::int64_t index) { return index >= 0 && index <= kLastIndex; }

bool is_possible_stamp(double stamp) { return std::abs(stamp) <= kLatestStamp; }

bool is_possible(const SE3& pose, double farthest) {
  return std::abs(pose.rotation().norm() - 1.0) < 1e-6 && pose.translation().norm() <= farthest;
}

bool is_possible(const MapPoint& p) {
  return p.position.norm() <= kFarthestInMap && p.normal.norm() <= 1.0 + 1e-6 &&
         p.distance >= 0.0F && static_cast<double>(p.distance) <= 2.0 * kFarthestInMap &&
         p.visible <= kMostTimes && p.found <= kMostTimes;
}

bool are_possible_keypoints(const Frame& f, const Camera& camera) {
  const PixelBox view = camera.view();
  const auto left = static_cast<float>(view.left - kMargin * camera.width);
  const auto right = static_cast<float>(view.right + kMargin * camera.width);
  const auto top = static_cast<float>(view.top - kMargin * camera.height);
  const auto bottom = static_cast<float>(view.bottom + kMargin * camera.height);
  bool good = f.size() <= kMostFrameKeypoints;
  for (const Eigen::Vector2f& p : f.pixels) {
    good &= (p.x() >= left) & (p.x() <= right) & (p.y() >= top) & (p.y() <= bottom);
  }
  return good &&
         all_of(f.depths,
                [](float d) {
                  return (d == 0.0F) | ((d >= kNearestReading) & (d <= kFarthestReading));
                }) &&
         all_of(f.scores, [](float s) { return (s >= -kLargestScore) & (s <= kLargestScore); }) &&
         all_of(f.sigmas, [](float s) { return (s >= kSmallestSigma) & (s <= kLargestSigma); });
}

bool are_possible_descriptors(const float* values, std::size_t rows, std::size_t dimension) {
  bool good = true;
  for (std::size_t row = 0; row < rows; ++row) {
    const Eigen::Map<const Eigen::VectorXf> descriptor(values + row * dimension,
                                                       static_cast<Eigen::Index>(dimension));
    good &= descriptor.squaredNorm() <= kLongestDescriptor * kLongestDescriptor;
  }
  return good;
}

bool is_possible_covisibility(const MapParts& parts) {
  std::size_t observations = 0;
  std::size_t most_pairs = 0;  // if no two points were seen by the same two keyframes
  for (const MapPoint& p : parts.points) {
    observations += p.observations.size();
    most_pairs += p.observations.size() * p.observations.size();
  }
  const std::size_t limit = kFreePairs + kPairsAnObservation * observations;
  if (most_pairs <= limit) return true;
  std::vector<std::vector<std::size_t>> seen(parts.keyframes.size());  // points by keyframe
  for (std::size_t i = 0; i < parts.points.size(); ++i) {
    for (const PointObservation& o : parts.points[i].observations) {
      if (o.keyframe < seen.size()) seen[o.keyframe].push_back(i);
    }
  }
  std::vector<std::size_t> counted_for(seen.size(), seen.size());
  std::size_t pairs = 0;
  for (std::size_t k = 0; k < seen.size() && pairs <= limit; ++k) {
    for (const std::size_t point : seen[k]) {
      for (const PointObservation& o : parts.points[point].observations) {
        if (o.keyframe >= seen.size() || counted_for[o.keyframe] == k) continue;
        counted_for[o.keyframe] = k;
        ++pairs;
      }
    }
  }
  return pairs <= limit;
}

void check_numbers(const MapSnapshot& snapshot, const std::string& where) {
  const auto expect = [&](bool possible, const std::string& what) {
    if (!possible) throw InputError(fmt::format("{}: the map is not saved: {}", where, what));
  };
  const MapHeader& header = snapshot.header;
  expect(snapshot.parts.rig.size() <= kMostCameras, "it is of too many cameras");
  for (Camera camera : snapshot.parts.rig.cameras()) camera.prepare(where);
  expect(is_possible(header.traits), "its descriptors are of an impossible kind");
  expect(is_possible_text(header.extractor) && is_possible_text(header.model_hash),
         "the name of its features is too long or holds control characters");
  expect(!snapshot.parts.keyframes.empty(), "it has no keyframe");
  for (const Keyframe& k : snapshot.parts.keyframes)
    check_frame(k, header, snapshot.parts.rig, where);
  for (const MapPoint& p : snapshot.parts.points) {
    if (!is_possible(p)) expect(false, fmt::format("impossible numbers in point {}", p.id));
  }
  expect(is_possible_covisibility(snapshot.parts), "too many pairs of keyframes share points");
  for (const StoredLoopEdge& loop : snapshot.loops) {
    expect(is_possible(loop.a_from_b, kLongestLoopEdge), "a loop edge is no rigid motion");
  }
  for (const std::string& picture : snapshot.thumbnails) {
    expect(picture.size() <= kLargestThumbnail, "a thumbnail is too large");
  }
}

}  // namespace dxslam
