// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include "core/options.h"
#include "map/local_map.h"
#include "optimization/bundle_adjustment.h"

namespace dxslam {

struct MappingOptions {
  int fuse_keyframes = 12;
  double fuse_radius = 4.0;
  double fuse_ratio = 0.95;
  double fuse_depth_tolerance = 0.1;
  double max_point_depth = 8.0;
  int triangulation_keyframes = 4;
  double min_parallax = 1.0;
  double epipolar_tolerance = 2.0;
  int min_observations = 3;
  int probation = 3;
  double min_found_ratio = 0.25;
  int bundle_keyframes = 30;
  int bundle_fixed_keyframes = 30;
  int bundle_min_shared = 15;
  double redundant_share = 0.9;
  double redundant_share_known = 0.7;
  int redundant_observers = 3;
  LocalMapOptions local_map;
  BundleOptions bundle{5, 8, 3e-4};

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("fuse_keyframes", self.fuse_keyframes, {1, 1000}, "keyframes",
          "neighbours with which points are fused");
    visit("fuse_radius", self.fuse_radius, {0.5, 100}, "pixels at 640 wide",
          "window around the pixel of a point to fuse");
    visit("fuse_ratio", self.fuse_ratio, {0.1, 1}, "",
          "nearest to second nearest descriptor distance");
    visit("fuse_depth_tolerance", self.fuse_depth_tolerance, {0.001, 10}, "",
          "relative difference of predicted and measured depth");
    visit(for_users("max_point_depth"), self.max_point_depth, {0.1, 1000}, "m",
          "farthest depth reading that makes a point");
    visit("triangulation_keyframes", self.triangulation_keyframes, {0, 100}, "keyframes",
          "neighbours with which keypoints without depth are triangulated");
    visit("min_parallax", self.min_parallax, {0.01, 90}, "degrees", "of a triangulated point");
    visit("epipolar_tolerance", self.epipolar_tolerance, {0.1, 100}, "pixels",
          "reprojection error of a triangulated point");
    visit("min_observations", self.min_observations, {1, 100}, "keyframes",
          "that must see a point at the end of its probation");
    visit("probation", self.probation, {1, 100}, "keyframes", "after which a new point is judged");
    visit("min_found_ratio", self.min_found_ratio, {0, 1}, "",
          "matched to expected sightings of a point on probation");
    visit("bundle_keyframes", self.bundle_keyframes, {1, 1000}, "keyframes",
          "most keyframes that local bundle adjustment moves");
    visit("bundle_fixed_keyframes", self.bundle_fixed_keyframes, {0, 1000}, "keyframes",
          "most keyframes that hold its border");
    visit("bundle_min_shared", self.bundle_min_shared, {1, 100000}, "points",
          "shared with the new keyframe by those it moves");
    visit(for_users("redundant_share"), self.redundant_share, {0.1, 1}, "",
          "share of points seen elsewhere that makes a keyframe redundant");
    visit("redundant_share_known", self.redundant_share_known, {0.1, 1}, "",
          "the same where most points are known from earlier recordings");
    visit("redundant_observers", self.redundant_observers, {1, 100}, "keyframes",
          "others that must see a point for that");
    visit.group("local_map", self.local_map);
    visit.group("bundle", self.bundle);
  }
  template <class Checker>
  void relate(const Checker& check) const {
    check.at_most("redundant_share_known", redundant_share_known, "redundant_share",
                  redundant_share);
  }
};

}  // namespace dxslam
