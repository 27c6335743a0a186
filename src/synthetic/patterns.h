// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

namespace dxslam {

/// What is painted on a surface. The materials repeat seamlessly; the pictures are seen once.
enum class Pattern {
  // materials
  kPlaster,
  kBrick,
  kStone,
  kPlanks,
  kWood,
  kTiles,
  kMosaic,
  kCarpet,
  kCeiling,
  kConcrete,
  kFabric,
  kMetal,
  kWallpaper,
  // pictures
  kPoster,
  kPainting,
  kBooks,
  kScreen,
  kNotice,
  kDoor,
  kWindow,
  kDrawers,
  kCarton,
  kPapers,
  kRug,
  kLeaves,
  kKeyboard,
  kClock,
  kLampPanel,
  kClothes,
  kFace,
};

/// Paints a pattern: CV_8UC3, BGR, gamma encoded. The same seed and size give the same picture.
cv::Mat paint_pattern(Pattern pattern, std::uint64_t seed, cv::Size size);

/// Side in metres of one repetition of the materials.
constexpr double kMaterialSize = 2.56;

}  // namespace dxslam
