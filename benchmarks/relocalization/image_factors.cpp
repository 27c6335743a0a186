// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "image_factors.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <random>

#include "synthetic/low_light.h"

namespace dxslam::benchmark {
namespace {

Query darkened(const Query& query, const LowLight& low_light) {
  Query dark = query;
  dark.image.color = low_light.apply(query.image.color, query.image.index);
  return dark;
}

void blank(Query& query, const cv::Rect& rect, double grey) {
  const cv::Rect inside = rect & cv::Rect(0, 0, query.image.color.cols, query.image.color.rows);
  query.image.color(inside).setTo(cv::Scalar::all(grey));
  if (!query.image.depth.empty()) query.image.depth(inside).setTo(0.0);
}

// Boxes of one grey each until 30 % of the image is hidden.
Query behind_patches(const Query& query, const Camera&) {
  Query hidden = query;
  hidden.image.color = query.image.color.clone();
  hidden.image.depth = query.image.depth.clone();
  const int width = query.image.color.cols, height = query.image.color.rows;
  cv::Mat mask = cv::Mat::zeros(height, width, CV_8U);
  std::mt19937 random(static_cast<unsigned>(query.image.index));
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  while (cv::countNonZero(mask) < 0.3 * width * height) {
    const cv::Rect rect(below(width) - width / 12, below(height) - height / 12,
                        width / 12 + below(width / 6), height / 12 + below(height / 4));
    cv::rectangle(mask, rect, 255, cv::FILLED);
    blank(hidden, rect, below(256));
  }
  return hidden;
}

cv::Mat blank_of(const cv::Mat& image) {
  return {image.size(), image.type(), cv::Scalar::all(0.0)};
}

Query only_the_middle(const Query& query, double margin) {
  const int width = query.image.color.cols, height = query.image.color.rows;
  const cv::Point corner(cvRound(margin * width), cvRound(margin * height));
  const cv::Rect middle(corner, cv::Point(width, height) - corner);
  Query cropped = query;
  cropped.image.color = blank_of(query.image.color);
  query.image.color(middle).copyTo(cropped.image.color(middle));
  if (query.image.depth.empty()) return cropped;
  cropped.image.depth = blank_of(query.image.depth);
  query.image.depth(middle).copyTo(cropped.image.depth(middle));
  return cropped;
}

// As of a camera turned about its axis.
Query turned(const Query& query, const Camera& camera, double degrees) {
  const double angle = degrees * std::numbers::pi / 180.0;
  const double c = std::cos(angle), s = std::sin(angle);
  const cv::Matx23d motion(c, -s, camera.cx - c * camera.cx + s * camera.cy,  //
                           s, c, camera.cy - s * camera.cx - c * camera.cy);
  Query result = query;
  result.image.color = blank_of(query.image.color);
  cv::warpAffine(query.image.color, result.image.color, motion, query.image.color.size());
  if (!query.image.depth.empty()) {
    result.image.depth = blank_of(query.image.depth);
    cv::warpAffine(query.image.depth, result.image.depth, motion, query.image.depth.size(),
                   cv::INTER_NEAREST);
  }
  result.turned_from_camera = SE3(so3_exp({0.0, 0.0, angle}), Eigen::Vector3d::Zero());
  return result;
}

}  // namespace

std::vector<ImageFactor> image_factors() {
  std::vector<ImageFactor> factors = {
      {"as recorded", [](const Query& query, const Camera&) { return query; }},
      {"patches over 30 %", behind_patches},
      {"middle 36 % alone", [](const Query& q, const Camera&) { return only_the_middle(q, 0.2); }},
      {"middle 16 % alone", [](const Query& q, const Camera&) { return only_the_middle(q, 0.3); }}};
  for (const double gain : {LowLight::kDefaultGain, 0.03}) {
    factors.push_back({fmt::format("low light at {}", gain),
                       [low_light = LowLight(gain)](const Query& query, const Camera&) {
                         return darkened(query, low_light);
                       }});
  }
  for (const double degrees : {15.0, 30.0, 45.0}) {
    factors.push_back({fmt::format("turned by {:.0f}°", degrees),
                       [degrees](const Query& query, const Camera& camera) {
                         return turned(query, camera, degrees);
                       }});
  }
  return factors;
}

}  // namespace dxslam::benchmark
