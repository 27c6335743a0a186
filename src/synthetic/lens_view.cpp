// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/lens_view.h"

#include <fmt/format.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/error.h"
#include "io/primitives/text_file.h"

namespace dxslam {

Lens synthetic_lens(const std::string& model) {
  // Of a Kinect, an Azure Kinect, a RealSense T265, and TUM VI.
  const std::vector<Lens> lenses = {
      {&kRadialTangential, {0.262383, -0.953104, -0.005358, 0.002628, 1.163314}},
      {&kRational, {0.45, -2.6, 0.0006, -0.0002, 1.55, 0.33, -2.42, 1.48}},
      {&kKannalaBrandt, {-0.0072, 0.0405, -0.0375, 0.0063}},
      {&kDoubleSphere, {-0.2, 0.59}}};
  if (model.empty()) return {};
  std::vector<std::string> known;
  for (const Lens& lens : lenses) {
    if (model == lens.model->name) return lens;
    known.emplace_back(lens.model->name);
  }
  throw InputError(
      fmt::format("unknown lens {}, expected one of {}", in_quotes(model), fmt::join(known, ", ")));
}

LensView::LensView(const Camera& camera) : pinhole_(camera) {
  constexpr double kMargin = 2.0;  // pixels, for the interpolation
  const PixelBox view = camera.view();
  pinhole_.lens = Lens();
  pinhole_.width = static_cast<int>(std::ceil(view.right - view.left + 2.0 * kMargin));
  pinhole_.height = static_cast<int>(std::ceil(view.bottom - view.top + 2.0 * kMargin));
  pinhole_.cx -= view.left - kMargin;
  pinhole_.cy -= view.top - kMargin;
  pinhole_.prepare("the pinhole behind a lens");
  from_.create(camera.height, camera.width, CV_32FC2);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const auto pixel = camera.undistort({x, y});
      cv::Vec2f& from = from_.at<cv::Vec2f>(y, x);
      from = {-10.0F, -10.0F};
      if (!pixel || !camera.contains(*pixel)) continue;
      from = {static_cast<float>(pixel->x() - view.left + kMargin),
              static_cast<float>(pixel->y() - view.top + kMargin)};
    }
  }
}

Rendering LensView::bent(const Rendering& drawn) const {
  const auto bend = [&](const cv::Mat& image, int interpolation, double outside) {
    cv::Mat result;
    cv::remap(image, result, from_, cv::noArray(), interpolation, cv::BORDER_CONSTANT,
              cv::Scalar::all(outside));
    return result;
  };
  Rendering result;
  result.radiance = cv::max(bend(drawn.radiance, cv::INTER_CUBIC, 0.0), 0.0);
  // No depth or surface lies between two others.
  result.depth = bend(drawn.depth, cv::INTER_NEAREST, 0.0);
  result.incidence = bend(drawn.incidence, cv::INTER_NEAREST, 0.0);
  cv::Mat surface;
  drawn.surface.convertTo(surface, CV_32F);
  bend(surface, cv::INTER_NEAREST, -1.0).convertTo(result.surface, CV_32S);
  return result;
}

}  // namespace dxslam
