// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <algorithm>
#include <memory>

#include "mutation.h"

namespace dxslam::fuzz {
namespace {

template <class Values>
auto& any_of(Values& values, Chance& chance) {
  return values[chance.below(values.size())];
}

// Frames are shared and never change: a keyframe gets a changed copy.
template <class Change>
void change_frame(Keyframe& k, Change change) {
  auto frame = std::make_shared<Frame>(*k.frame);
  frame->descriptors = k.frame->descriptors.clone();
  change(*frame);
  k.frame = frame;
}

Eigen::Vector3d nasty_vector(const Eigen::Vector3d& now, Chance& chance) {
  Eigen::Vector3d v = now;
  if (chance.one_in(3)) return v * chance.number(1.0);
  v[static_cast<Eigen::Index>(chance.below(3))] = chance.number(v.x());
  if (chance.one_in(3)) v[static_cast<Eigen::Index>(chance.below(3))] = chance.number(v.z());
  return v;
}

SE3 nasty_pose(const SE3& now, const MapParts& parts, Chance& chance) {
  switch (chance.below(5)) {
    case 0:
      return parts.keyframes[chance.below(parts.keyframes.size())].world_from_camera;
    case 1:
      return now * SE3(so3_exp({7.0 * chance.uniform(), 7.0 * chance.uniform(), 0.0}),
                       Eigen::Vector3d::Zero());
    case 2:
      return now.inverse();
    default:
      return {now.rotation(), nasty_vector(now.translation(), chance)};
  }
}

void spoil_camera(Camera& c, Chance& chance) {
  double* const values[] = {&c.fx,
                            &c.fy,
                            &c.cx,
                            &c.cy,
                            &c.lens.parameters[chance.below(c.lens.parameters.size())],
                            &c.fps,
                            &c.depth_factor,
                            &c.depth_baseline,
                            &c.disparity_noise,
                            &c.max_depth};
  double& value =
      **std::next(std::begin(values), static_cast<std::ptrdiff_t>(chance.below(std::size(values))));
  value = chance.number(value);
  if (chance.one_in(4))
    c.width = static_cast<int>(chance.id(static_cast<std::uint32_t>(c.width), 700));
  if (chance.one_in(4))
    c.height = static_cast<int>(chance.id(static_cast<std::uint32_t>(c.height), 500));
}

// One camera, or which of them took a frame.
void spoil_rig(MapParts& parts, Chance& chance) {
  std::vector<Camera> cameras = parts.rig.cameras();
  const std::size_t which = chance.below(cameras.size());
  Camera spoilt = cameras[which];
  if (chance.one_in(4)) spoilt.lens.model = lens_models()[chance.below(lens_models().size())];
  spoil_camera(spoilt, chance);
  if (chance.one_in(2)) {
    cameras[which] = spoilt;
  } else {
    cameras.push_back(spoilt);
    const std::size_t k = chance.below(parts.keyframes.size());
    auto frame = std::make_shared<Frame>(*parts.keyframes[k].frame);
    frame->camera = static_cast<CameraId>(chance.below(cameras.size() + 1));
    parts.keyframes[k].frame = std::move(frame);
  }
  parts.rig = Rig();
  for (const Camera& camera : cameras) parts.rig.add(camera);
}

void spoil_header(MapHeader& header, MapParts& parts, Chance& chance) {
  DescriptorTraits& traits = header.traits;
  switch (chance.below(5)) {
    case 0:
      traits.max_distance = chance.number(traits.max_distance);
      break;
    case 1:
      traits.global_dimension = static_cast<int>(chance.below(6));
      break;
    case 2:
      header.extractor = chance.one_in(2) ? "../" + header.extractor : "hfnet";
      break;
    case 3:
      header.model_hash.assign(chance.below(80), 'a');
      break;
    default:
      spoil_rig(parts, chance);
  }
}

void spoil_keypoint(Frame& frame, std::size_t i, Chance& chance) {
  switch (chance.below(6)) {
    case 0:
      frame.pixels[i].x() = chance.number(frame.pixels[i].x());
      break;
    case 1:
      frame.pixels[i].y() = chance.number(frame.pixels[i].y());
      break;
    case 2:
      frame.depths[i] = chance.number(frame.depths[i]);
      break;
    case 3:
      frame.scores[i] = chance.number(frame.scores[i]);
      break;
    case 4:
      frame.sigmas[i] = chance.number(frame.sigmas[i]);
      break;
    default:
      frame.pixels[i] = any_of(frame.pixels, chance);
  }
}

// One number for all keypoints.
void level_keypoints(Frame& frame, Chance& chance) {
  const std::size_t i = chance.below(frame.size());
  switch (chance.below(6)) {
    case 0:
      std::fill(frame.pixels.begin(), frame.pixels.end(), frame.pixels[i]);
      break;
    case 1:
      for (Eigen::Vector2f& p : frame.pixels) p.x() = frame.pixels[i].x();
      break;
    case 2:
      std::fill(frame.depths.begin(), frame.depths.end(), chance.number(frame.depths[i]));
      break;
    case 3:
      std::fill(frame.sigmas.begin(), frame.sigmas.end(), chance.number(frame.sigmas[i]));
      break;
    case 4:
      std::fill(frame.scores.begin(), frame.scores.end(), chance.number(frame.scores[i]));
      break;
    default: {
      const float by = chance.number(1.0F);
      for (float& depth : frame.depths) depth *= by;
    }
  }
}

void spoil_descriptors(Frame& frame, Chance& chance) {
  cv::Mat& d = frame.descriptors;
  const auto row = static_cast<int>(chance.below(frame.size()));
  switch (chance.below(4)) {
    case 0:
      d.setTo(0);
      break;
    case 1:
      for (int r = 0; r < d.rows; ++r) {
        if (r != row) d.row(row).copyTo(d.row(r));
      }
      break;
    case 2:
      d.row(row).setTo(0);
      break;
    default:
      if (d.type() == CV_32FC1) {
        float& value = d.at<float>(row, static_cast<int>(chance.below(32)));
        value = chance.number(value);
      } else {
        d.row(row).setTo(static_cast<double>(chance.below(256)));
      }
  }
}

void empty_frame(Keyframe& k, MapParts& parts) {
  change_frame(k, [](Frame& f) {
    f.pixels.clear();
    f.depths.clear();
    f.scores.clear();
    f.sigmas.clear();
    f.descriptors = f.descriptors.rowRange(0, 0);
  });
  for (MapPoint& p : parts.points) {
    std::erase_if(p.observations, [&](const PointObservation& o) { return o.keyframe == k.id; });
    p.descriptor = 0;
  }
  std::erase_if(parts.points, [](const MapPoint& p) { return p.observations.empty(); });
}

void spoil_frame(Keyframe& k, MapParts& parts, Chance& chance) {
  if (k.frame->size() == 0) return;
  if (chance.one_in(12)) return empty_frame(k, parts);
  change_frame(k, [&](Frame& f) {
    switch (chance.below(7)) {
      case 0:
        f.stamp = chance.number(f.stamp);
        break;
      case 1:
        f.index = static_cast<std::int64_t>(chance.bits() >> chance.below(64));
        break;
      case 2:
        for (float& g : f.global) g = chance.one_in(2) ? 0.0F : chance.number(g);
        break;
      case 3:
        spoil_descriptors(f, chance);
        break;
      case 4:
        level_keypoints(f, chance);
        break;
      default:
        spoil_keypoint(f, chance.below(f.size()), chance);
    }
  });
}

void spoil_keyframe(Keyframe& k, MapParts& parts, Chance& chance) {
  switch (chance.below(10)) {
    case 0:
      k.parent = chance.id(k.parent, parts.keyframes.size());
      break;
    case 1:
      k.component = chance.id(k.component, parts.keyframes.size());
      break;
    case 2:
      parts.last_keyframe = chance.id(parts.last_keyframe, parts.keyframes.size());
      break;
    case 3:
    case 4:
    case 5:
      k.world_from_camera = nasty_pose(k.world_from_camera, parts, chance);
      break;
    default:
      spoil_frame(k, parts, chance);
  }
}

void spoil_observations(MapPoint& p, const MapParts& parts, Chance& chance) {
  if (p.observations.empty()) return;
  PointObservation& o = any_of(p.observations, chance);
  switch (chance.below(6)) {
    case 0:
      o.keyframe = chance.id(o.keyframe, parts.keyframes.size());
      break;
    case 1:
      o.keypoint = chance.id(o.keypoint, 150);
      break;
    case 2:
      p.observations.pop_back();
      break;
    case 3:
      p.observations.push_back(o);
      break;
    case 4:
      std::reverse(p.observations.begin(), p.observations.end());
      break;
    default:
      if (!parts.points.empty()) {
        const MapPoint& other = parts.points[chance.below(parts.points.size())];
        p.observations = other.observations;
      }
  }
}

void spoil_point(MapPoint& p, const MapParts& parts, Chance& chance) {
  switch (chance.below(8)) {
    case 0:
      p.position = nasty_vector(p.position, chance);
      break;
    case 1:
      p.position =
          parts.keyframes[chance.below(parts.keyframes.size())].world_from_camera.translation();
      break;
    case 2:
      p.normal = nasty_vector(p.normal, chance);
      break;
    case 3:
      p.distance = chance.number(p.distance);
      break;
    case 4:
      p.created_by = chance.id(p.created_by, parts.keyframes.size());
      break;
    case 5:
      (chance.one_in(2) ? p.visible : p.found) = chance.id(p.visible, 10);
      break;
    case 6:
      p.descriptor = chance.id(p.descriptor, p.observations.size());
      break;
    default:
      spoil_observations(p, parts, chance);
  }
}

// The same change for all.
void spoil_all(MapParts& parts, Chance& chance) {
  const double by = chance.number(1.0);
  const Eigen::Vector3d there = nasty_vector(Eigen::Vector3d(0.0, 0.0, 3.0), chance);
  const std::size_t kind = chance.below(9);
  for (Keyframe& k : parts.keyframes) {
    SE3& pose = k.world_from_camera;
    if (kind == 0) pose = parts.keyframes.front().world_from_camera;
    if (kind == 1) pose = SE3(pose.rotation(), by * pose.translation());
    if (kind == 2) pose = SE3(pose.rotation(), pose.translation() + there);
    if (kind == 3) spoil_frame(k, parts, chance);
  }
  for (MapPoint& p : parts.points) {
    if (kind == 1 || kind == 4) p.position *= by;
    if (kind == 2) p.position += there;
    if (kind == 5) p.position = there;
    if (kind == 6) p.normal.setZero();
    if (kind == 7) p.distance = static_cast<float>(by);
    if (kind == 8) spoil_point(p, parts, chance);
  }
}

void spoil_loops(MapSnapshot& snapshot, Chance& chance) {
  const std::size_t keyframes = snapshot.parts.keyframes.size();
  if (snapshot.loops.empty() || chance.one_in(3)) {
    snapshot.loops.push_back({chance.id(0, keyframes), chance.id(1, keyframes), SE3()});
  }
  StoredLoopEdge& loop = any_of(snapshot.loops, chance);
  if (chance.one_in(2)) loop.a = chance.id(loop.a, keyframes);
  if (chance.one_in(3)) loop.b = chance.id(loop.b, keyframes);
  if (chance.one_in(2)) loop.a_from_b = nasty_pose(loop.a_from_b, snapshot.parts, chance);
  if (chance.one_in(8)) snapshot.loops.assign(50, loop);
}

}  // namespace

void spoil_content(MapSnapshot& snapshot, Chance& chance) {
  MapParts& parts = snapshot.parts;
  switch (chance.below(8)) {
    case 0:
      spoil_header(snapshot.header, snapshot.parts, chance);
      break;
    case 1:
      spoil_loops(snapshot, chance);
      break;
    case 2:
      spoil_all(parts, chance);
      break;
    case 3:
    case 4:
      if (!parts.points.empty()) spoil_point(any_of(parts.points, chance), parts, chance);
      break;
    default:
      spoil_keyframe(any_of(parts.keyframes, chance), parts, chance);
  }
}

}  // namespace dxslam::fuzz
