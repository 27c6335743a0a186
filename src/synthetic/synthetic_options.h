// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <vector>

#include "core/options.h"
#include "synthetic/camera_path.h"

namespace dxslam {

/// What sets a recording apart from another one of the same place. Each factor stands alone and is
/// off at 0; the same seed gives the same outcome whatever other factors are on.
struct FactorOptions {
  double viewpoint = 0.0;
  double illumination = 0.0;
  double low_light = 0.0;
  double changed_objects = 0.0;
  double people = 0.0;
  double exposure_drift = 0.0;
  double motion_blur = 0.0;
  double image_noise = 1.0;
  double depth_noise = 1.0;
  int seed = 1;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("viewpoint", self.viewpoint, {-1.0, 1.0}, "",
          "path shifted to the right by 0.35 m times this, raised by 0.2 m, look turned by 15 deg");
    visit("illumination", self.illumination, {0.0, 1.0}, "",
          "other lamps, colours, directions and exposure");
    visit("low_light", self.low_light, {0.0, 1.0}, "gain", "dark, noisy grey images; 0: daylight");
    visit("changed_objects", self.changed_objects, {0.0, 1.0}, "share",
          "furniture and pictures that were moved, removed or replaced");
    visit("people", self.people, {0.0, 2.0}, "persons", "mean number of people in view");
    visit("exposure_drift", self.exposure_drift, {0.0, 2.0}, "",
          "slow swing of the gain; 1: +-50 %");
    visit("motion_blur", self.motion_blur, {0.0, 3.0}, "", "exposure time over 20 ms");
    visit("image_noise", self.image_noise, {0.0, 20.0}, "",
          "noise of the image; 1: 1.5 grey levels");
    visit("depth_noise", self.depth_noise, {0.0, 20.0}, "",
          "noise, steps and holes of the depth; 1: a structured-light sensor, 0: perfect");
    visit("seed", self.seed, {0, 2147483647}, "", "seed of all factors");
  }
};

/// A synthetic recording.
struct SyntheticOptions {
  std::string scene = "room";
  int seed = 1;
  int frames = 0;
  double fps = 15.0;
  int width = 640;
  int height = 480;
  double focal_length = 525.0 / 640.0;
  std::string lens;
  int threads = 2;
  PathOptions path;
  FactorOptions factors;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit("scene", self.scene, "", "room, office (6 rooms, 69 m) or corridor (a loop of 208 m)");
    visit("seed", self.seed, {0, 2147483647}, "", "seed of the place and of the walk");
    visit("frames", self.frames, {0, 1000000}, "frames", "most frames; 0: the whole path");
    visit("fps", self.fps, {0.01, 240.0}, "1/s", "frame rate");
    visit("width", self.width, {32, 4096}, "pixels", "of the images");
    visit("height", self.height, {32, 4096}, "pixels", "of the images");
    visit("focal_length", self.focal_length, {0.2, 5.0}, "image widths", "of the camera");
    visit("lens", self.lens, "", "model of the lens; empty: none");
    visit("threads", self.threads, {1, 256}, "", "threads; has no influence on the result");
    visit.group("path", self.path);
    visit.group("factors", self.factors);
  }
};

/// A factor that can be switched on by name.
struct FactorName {
  const char* name;
  double FactorOptions::* strength;
  double usual;         ///< strength where none is given
  const char* meaning;  ///< of the strength
};

const std::vector<FactorName>& factor_names();

/// Switches on a factor given as NAME or NAME=STRENGTH. Throws InputError for an unknown name, with
/// the known ones, or a strength that is no number or out of range.
void set_factor(FactorOptions& factors, const std::string& text);

}  // namespace dxslam
