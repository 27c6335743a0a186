// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include "core/options.h"

namespace dxslam {

/// How depth images become a floor plan.
struct GridOptions {
  double cell = 0.05;
  double min_height = 0.1;
  double max_height = 1.8;
  double max_drop = 0.3;
  double max_range = 4.0;
  double bearing_step = 0.5;
  int pixel_step = 3;
  int min_support = 3;
  int min_hits = 2;
  double min_hit_share = 0.35;
  double max_extent = 500.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit(for_users("cell"), self.cell, {0.005, 10}, "m", "side of a cell of the grid");
    visit(for_users("min_height"), self.min_height, {0.0, 10}, "m",
          "above the floor: what is lower may be driven over");
    visit(for_users("max_height"), self.max_height, {0.01, 100}, "m",
          "above the floor: what is higher may be driven under");
    visit("max_drop", self.max_drop, {0.0, 100}, "m", "below the floor: what is lower is no floor");
    visit(for_users("max_range"), self.max_range, {0.1, 100}, "m",
          "farthest, along the floor, that a depth image says something");
    visit("bearing_step", self.bearing_step, {0.05, 10}, "degrees",
          "between two directions in which an image is looked along");
    visit("pixel_step", self.pixel_step, {1, 64}, "pixels", "every n-th column and row is used");
    visit("min_support", self.min_support, {1, 100}, "pixels",
          "that must show an obstacle in one direction");
    visit("min_hits", self.min_hits, {1, 1000}, "images", "that must show something in a cell");
    visit("min_hit_share", self.min_hit_share, {0.01, 1}, "",
          "of the images that show a cell, those that show something in it");
    visit("max_extent", self.max_extent, {1, 10000}, "m",
          "cells farther from the origin, along x or y, are left out");
  }

  template <class Checker>
  void relate(const Checker& check) const {
    check.at_most("min_height", min_height, "max_height", max_height);
  }
};

}  // namespace dxslam
