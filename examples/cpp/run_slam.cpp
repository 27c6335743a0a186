// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// Runs SLAM on a recording (a folder or a bag), prints the pose of every tracked frame as
// "stamp tx ty tz qx qy qz qw", and saves the map if a name is given.
#include <dxslam/dxslam.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <string>

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: run_slam RECORDING [MAP]\n");
    return 2;
  }
  try {
    const std::unique_ptr<dxslam::RgbdSequence> recording = dxslam::open_sequence(argv[1]);
    dxslam::SystemOptions options;
    options.features = dxslam::choose_extractor().name;
    dxslam::System system(recording->camera(),
                          dxslam::make_extractor(options.features, options.extractor), options);

    // Your own camera goes here: index, stamp, colour (BGR) and depth (metres) of an image.
    for (std::size_t i = 0; i < recording->size(); ++i) {
      if (const std::optional<dxslam::RgbdImage> image = recording->read(i)) system.process(*image);
    }
    system.finish();

    for (const dxslam::StampedPose& pose : system.trajectory()) {
      std::printf("%s\n", dxslam::format_pose(pose).c_str());
    }
    if (argc > 2) {
      dxslam::save_system_map(argv[2], dxslam::map_header(system.extractor()), system.map(),
                              system.closed_loops());
    }
  } catch (const dxslam::InputError& error) {  // one sentence: what, where, what was expected
    std::fprintf(stderr, "run_slam: %s\n", error.what());
    return 3;
  }
  return 0;
}
