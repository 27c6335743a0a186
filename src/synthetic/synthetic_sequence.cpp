// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/synthetic_sequence.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "synthetic/factors.h"
#include "synthetic/random.h"
#include "synthetic/sensor.h"
#include "synthetic/world_builder.h"

namespace dxslam {
namespace {

constexpr double kExposureTime = 0.02;  // seconds, at motion_blur = 1
constexpr int kBlurSamples = 6;

// A Kinect by default; depth in millimetres.
Camera camera_of(const SyntheticOptions& options) {
  Camera camera;
  camera.width = options.width;
  camera.height = options.height;
  camera.fx = camera.fy = options.focal_length * options.width;
  camera.cx = 0.5 * (options.width - 1);
  camera.cy = 0.5 * (options.height - 1);
  camera.fps = options.fps;
  camera.depth_factor = 1000.0;
  camera.depth_baseline = 0.075;
  camera.max_depth = 10.0;
  camera.lens = synthetic_lens(options.lens);
  camera.prepare("the synthetic camera");
  return camera;
}

}  // namespace

SyntheticSequence::SyntheticSequence(const SyntheticOptions& options)
    : options_(options), name_("synthetic " + options.scene) {
  validate_options("synthetic", options);
  const auto seed = static_cast<std::uint64_t>(options.seed);
  const auto factor_seed = static_cast<std::uint64_t>(options.factors.seed);
  camera_ = camera_of(options);
  if (camera_.has_distortion()) lens_view_.emplace(camera_);
  layout_ = make_layout(options.scene, seed);
  apply_factors(layout_, options.factors);
  path_.emplace(layout_, path_with_factors(options.path, options.factors), seed);
  world_ = build_world(layout_, seed, options.threads);
  people_.emplace(world_, *path_, options.factors.people, mix_seed(factor_seed, 4));
  if (options.factors.low_light > 0.0) low_light_.emplace(options.factors.low_light, factor_seed);

  const int whole = 1 + static_cast<int>(path_->duration() * options.fps);
  const int frames = options.frames > 0 ? std::min(options.frames, whole) : whole;
  for (int i = 0; i < frames; ++i) {
    const double time = i / options.fps;
    ground_truth_.push_back({time, path_->world_from_camera(time)});
  }
}

double SyntheticSequence::stamp(std::size_t index) const {
  require(index < size(), "frame index beyond the sequence");
  return ground_truth_[index].stamp;
}

double SyntheticSequence::path_length() const {
  return path_->length_at(ground_truth_.back().stamp);
}

Rendering SyntheticSequence::seen(const std::vector<Surface>& extra, const SE3& world_from_camera,
                                  const RenderOptions& options) const {
  if (!lens_view_) return render(world_, extra, camera_, world_from_camera, options);
  return lens_view_->bent(render(world_, extra, lens_view_->pinhole(), world_from_camera, options));
}

Rendering SyntheticSequence::draw_ideal(std::size_t index, int threads) const {
  const StampedPose& pose = ground_truth_[index];
  RenderOptions options;
  options.threads = threads;
  return seen(people_->surfaces_at(world_, pose.stamp), pose.world_from_camera, options);
}

// Mean over moments of the exposure, the places within a pixel spread evenly.
cv::Mat SyntheticSequence::exposed_radiance(const Rendering& sharp, double time,
                                            int threads) const {
  const double exposure = kExposureTime * options_.factors.motion_blur;
  if (exposure <= 0.0) return sharp.radiance;
  cv::Mat sum = cv::Mat::zeros(sharp.radiance.size(), CV_32FC3);
  for (int k = 0; k < kBlurSamples; ++k) {
    const double part = (k + 0.5) / kBlurSamples - 0.5, moment = time + exposure * part;
    RenderOptions options;
    options.threads = threads;
    options.antialias = false;
    options.shift_x = part;
    options.shift_y = std::fmod(k * 0.618034, 1.0) - 0.5;
    sum += seen(people_->surfaces_at(world_, moment), path_->world_from_camera(moment), options)
               .radiance;
  }
  return sum * (1.0 / kBlurSamples);
}

RgbdImage SyntheticSequence::draw(std::size_t index, int threads) const {
  require(index < size(), "frame index beyond the sequence");
  const FactorOptions& factors = options_.factors;
  const std::uint64_t frame_seed =
      mix_seed(mix_seed(static_cast<std::uint64_t>(factors.seed), 5), index);
  const Rendering sharp = draw_ideal(index, threads);
  RgbdImage image;
  image.index = static_cast<std::int64_t>(index);
  image.stamp = ground_truth_[index].stamp;
  image.color = develop_image(exposed_radiance(sharp, image.stamp, threads),
                              exposure_gain(factors, image.stamp), factors.image_noise, frame_seed);
  if (low_light_) image.color = low_light_->apply(image.color, image.index);
  image.depth = measure_depth(sharp, camera_, factors.depth_noise, mix_seed(frame_seed, 6));
  return image;
}

std::optional<RgbdImage> SyntheticSequence::read(std::size_t index) {
  return draw(index, options_.threads);
}

std::unique_ptr<SyntheticSequence> make_synthetic_sequence(const SyntheticOptions& options) {
  return std::make_unique<SyntheticSequence>(options);
}

}  // namespace dxslam
