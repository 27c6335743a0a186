// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
//
// Finds where in a saved map a single image was taken, by the camera that made the map.
#include <dxslam/dxslam.h>

#include <cstdio>
#include <memory>

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: find_image MAP COLOUR [DEPTH]\n");
    return 2;
  }
  try {
    const dxslam::StoredMap stored = dxslam::load_map(argv[1]);
    const dxslam::Camera& camera = stored.map.rig()[0];
    const std::unique_ptr<dxslam::FeatureExtractor> extractor =
        dxslam::make_extractor(stored.header.extractor);
    dxslam::require_same_features(stored.header, dxslam::map_header(*extractor), argv[1]);

    dxslam::RgbdImage image;
    const dxslam::ExpectedSize size{{camera.width, camera.height}, "the map's camera"};
    image.color = dxslam::read_color_image(argv[2], size);
    if (argc > 3) {  // raw units, or metres already
      const cv::Mat depth = dxslam::read_depth_image(argv[3], size);
      const double metres = depth.type() == CV_16UC1 ? 1.0 / camera.depth_factor : 1.0;
      depth.convertTo(image.depth, CV_32F, metres);
    }
    const dxslam::FramePtr frame =
        dxslam::make_frame(image, extractor->extract(image.color, true), camera);

    // To ask many images, keep these two.
    const dxslam::GlobalIndex index = dxslam::index_keyframes(stored.map);
    const dxslam::Relocalizer relocalizer(camera, extractor->traits());
    const dxslam::RelocalizationReport report = relocalizer.relocalize(stored.map, index, *frame);
    if (!report.accepted) {
      std::printf("not found\n");
      return 1;
    }
    std::printf("%s\n", dxslam::format_pose({0.0, report.world_from_camera}).c_str());
    std::fprintf(stderr, "confidence %.3f\n", report.confidence);
  } catch (const dxslam::InputError& error) {
    std::fprintf(stderr, "find_image: %s\n", error.what());
    return 3;
  }
  return 0;
}
