// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "apps/command_files.h"
#include "apps/console.h"
#include "apps/features_arguments.h"
#include "apps/usage.h"
#include "core/error.h"
#include "io/primitives/atomic_file.h"
#include "io/primitives/image_file.h"
#include "io/primitives/picture_mark.h"
#include "matching/descriptor_matching.h"

namespace dxslam::apps {
namespace {

constexpr const char* kSoftware = "dxslam match";

struct MatchArguments {
  FeatureArguments extractor;
  std::string first;
  std::string second;
  std::string picture;
  double threshold = 8.0;  // pixels
  double low_light = 0.0;
};

cv::Point2f position(const Features& features, int index) {
  const Keypoint& keypoint = features.keypoints[static_cast<std::size_t>(index)];
  return {keypoint.x, keypoint.y};
}

/// One flag per match: within `threshold` pixels of the homography that most matches agree on.
std::vector<char> find_inliers(const Features& a, const Features& b,
                               const std::vector<Match>& matches, double threshold) {
  std::vector<char> inlier(matches.size(), 0);
  if (matches.size() < 4) return inlier;
  std::vector<cv::Point2f> from;
  std::vector<cv::Point2f> to;
  for (const Match& match : matches) {
    from.push_back(position(a, match.a));
    to.push_back(position(b, match.b));
  }
  constexpr int kIterations = 5000;
  constexpr double kConfidence = 0.999;
  cv::Mat mask;
  cv::findHomography(from, to, cv::RANSAC, threshold, mask, kIterations, kConfidence);
  for (std::size_t i = 0; i < inlier.size() && !mask.empty(); ++i) {
    inlier[i] = static_cast<char>(mask.at<std::uint8_t>(static_cast<int>(i)) != 0);
  }
  return inlier;
}

cv::Mat to_color(const cv::Mat& image) {
  if (image.channels() == 3) return image;
  cv::Mat color;
  cv::cvtColor(image, color, cv::COLOR_GRAY2BGR);
  return color;
}

/// Both images side by side; inliers as green lines, the other matches as red ones, thin enough to
/// leave the images visible, and all keypoints as dots.
cv::Mat draw(const cv::Mat& first, const cv::Mat& second, const Features& a, const Features& b,
             const std::vector<Match>& matches, const std::vector<char>& inlier) {
  const cv::Scalar yellow(0, 220, 255);
  const cv::Scalar red(40, 40, 255);
  const cv::Scalar green(60, 230, 60);
  constexpr double kLineOpacity = 0.4;
  cv::Mat canvas(std::max(first.rows, second.rows), first.cols + second.cols, CV_8UC3,
                 cv::Scalar::all(0));
  to_color(first).copyTo(canvas(cv::Rect(0, 0, first.cols, first.rows)));
  to_color(second).copyTo(canvas(cv::Rect(first.cols, 0, second.cols, second.rows)));
  const cv::Point2f shift(static_cast<float>(first.cols), 0.0F);
  cv::Mat lines = canvas.clone();
  for (const bool draw_inliers : {false, true}) {
    for (std::size_t i = 0; i < matches.size(); ++i) {
      if ((inlier[i] != 0) != draw_inliers) continue;
      cv::line(lines, position(a, matches[i].a), position(b, matches[i].b) + shift,
               draw_inliers ? green : red, 1, cv::LINE_AA);
    }
  }
  cv::addWeighted(lines, kLineOpacity, canvas, 1.0 - kLineOpacity, 0.0, canvas);
  for (const Keypoint& k : a.keypoints) {
    cv::circle(canvas, cv::Point2f(k.x, k.y), 1, yellow, cv::FILLED);
  }
  for (const Keypoint& k : b.keypoints) {
    cv::circle(canvas, cv::Point2f(k.x, k.y) + shift, 1, yellow, cv::FILLED);
  }
  return canvas;
}

void match(const MatchArguments& arguments) {
  CommandFiles({arguments.first, arguments.second})
      .writes("--out", arguments.picture,
              marked_picture_kind("a picture of `dxslam match`", kSoftware));
  const auto extractor = make_extractor(arguments.extractor);
  const cv::Mat first = read_image(arguments.first, 0.0);
  const cv::Mat second = read_image(arguments.second, arguments.low_light);
  const Features a = extractor->extract(first, false);
  const Features b = extractor->extract(second, false);
  const auto matches =
      match_mutual(a.descriptors, b.descriptors, extractor->traits().max_distance, 1.0F);
  const auto inlier = find_inliers(a, b, matches, arguments.threshold);
  const auto inliers = std::count(inlier.begin(), inlier.end(), 1);
  print("{}: {} and {} keypoints, {} mutual nearest neighbours, {} agree with a homography\n",
        extractor->name(), a.size(), b.size(), matches.size(), inliers);
  if (!arguments.picture.empty()) {
    const cv::Mat picture = draw(first, second, a, b, matches, inlier);
    write_file_atomically(arguments.picture,
                          mark_picture(encode_image(arguments.picture, picture), kSoftware));
  }
}

}  // namespace

void add_match_command(CLI::App& app) {
  auto arguments = std::make_shared<MatchArguments>();
  CLI::App* command = app.add_subcommand("match", "match the features of two images");
  command->add_option("first", arguments->first, "image file")->required();
  command->add_option("second", arguments->second, "image file")->required();
  command->add_option("--out", arguments->picture, "picture of the matches to write");
  command
      ->add_option("--threshold", arguments->threshold,
                   "pixels from the homography that an inlier may be")
      ->check(number(0.1, 100.0))
      ->capture_default_str();
  add_feature_options(*command, arguments->extractor);
  add_low_light_option(*command, arguments->low_light);
  command->callback([arguments] { match(*arguments); });
}

}  // namespace dxslam::apps
