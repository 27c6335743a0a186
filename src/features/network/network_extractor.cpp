// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "features/network/network_extractor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "features/network/network_input.h"
#include "features/network/openvino_engine.h"
#include "features/post_processing/cell_scores.h"
#include "features/post_processing/dense_scores.h"
#include "features/post_processing/descriptor_detection.h"
#include "features/post_processing/descriptor_sampling.h"
#include "features/post_processing/keypoint_selection.h"
#include "features/post_processing/non_maximum_suppression.h"
#include "features/post_processing/subpixel.h"
#include "features/stage_timer.h"

namespace dxslam {
namespace {

DetectorOptions detector_options(const ModelManifest& manifest, const ExtractorOptions& options) {
  DetectorOptions detector = manifest.detector;
  if (options.max_keypoints > 0) detector.max_keypoints = options.max_keypoints;
  if (options.score_threshold >= 0.0) detector.score_threshold = options.score_threshold;
  if (options.nms_radius >= 0) detector.nms_radius = options.nms_radius;
  if (options.nms_iterations >= 0) detector.nms_iterations = options.nms_iterations;
  if (options.spread >= 0.0) detector.spread = options.spread;
  return detector;
}

/// Stands for "above 0" where logarithms are taken.
constexpr double kLowestScore = 1e-9;

float logit(double probability) {
  const double p = std::clamp(probability, kLowestScore, 1.0 - kLowestScore);
  return static_cast<float>(std::log(p / (1.0 - p)));
}

float sigmoid(float x) { return 1.0F / (1.0F + std::exp(-x)); }

void normalize(std::vector<float>& vector) {
  double sum = 0.0;
  for (const float v : vector) sum += static_cast<double>(v) * v;
  const double scale = sum > 0.0 ? 1.0 / std::sqrt(sum) : 0.0;
  for (float& v : vector) v = static_cast<float>(v * scale);
}

bool has_unknown_weights(const ModelManifest& manifest) {
  const auto unknown = [](const ModelFile& file) {
    const bool is_ir = std::filesystem::path(file.path).extension() == ".xml";
    return file.given() && (file.sha256.empty() || (is_ir && file.weights_sha256.empty()));
  };
  const auto any_unknown = [&](const ModelVariants& files) {
    return unknown(files.floating) || unknown(files.int8);
  };
  return any_unknown(manifest.files) ||
         (manifest.global_head && any_unknown(manifest.global_head->files));
}

class NetworkExtractor final : public FeatureExtractor {
 public:
  NetworkExtractor(const ModelManifest& manifest, const ExtractorOptions& options)
      : manifest_(manifest),
        detector_(detector_options(manifest, options)),
        engine_(manifest, options),
        input_(manifest.input, engine_.integer_input()),
        cells_(manifest.cell_size) {
    traits_.dimension = manifest.descriptor.dimension;
    traits_.max_distance = static_cast<float>(manifest.descriptor.max_distance);
    traits_.global_dimension = manifest.global_dimension;
  }

  const std::string& name() const override { return manifest_.name; }
  const DescriptorTraits& traits() const override { return traits_; }
  std::string precision() const override { return engine_.precision(); }
  std::string model_hash() const override {
    // Of the float weights: those of other precisions are made from them and give like descriptors.
    const ModelFile& file = manifest_.files.floating;
    return file.weights_sha256.empty() ? file.sha256 : file.weights_sha256;
  }
  std::vector<std::string> notes() const override {
    std::vector<std::string> notes;
    if (!engine_.cache_note().empty()) notes.push_back(engine_.cache_note());
    if (has_unknown_weights(manifest_)) {
      notes.push_back(fmt::format(
          "{}: says no SHA-256 of a model file, so another or a damaged model is not noticed",
          manifest_.path));
    }
    return notes;
  }
  std::vector<StageTime> last_stages() const override { return timer_.stages(); }

  Features extract(const cv::Mat& image, bool with_global) override {
    timer_.start();
    const cv::Mat& prepared = input_.prepare(image);
    timer_.stop("preprocess");
    engine_.run(prepared, with_global && traits_.global_dimension > 0);
    timer_.stop("network");
    find_candidates(input_.size());
    select(input_.size());
    timer_.stop("detect");
    Features features = describe();
    if (keeps_encoder_) features.encoder = engine_.encoder();
    timer_.stop("describe");
    return features;
  }

  void keep_encoder(bool keep) override { keeps_encoder_ = keep; }

  std::vector<float> global_of(const cv::Mat& encoder) override {
    std::vector<float> global = engine_.global_of(encoder);
    normalize(global);
    return global;
  }

 private:
  /// Fills candidates_ with the maxima, in the detector's own units of score.
  void find_candidates(const cv::Size& size) {
    candidates_.clear();
    const PixelArea area = input_.area(detector_.border);
    if (manifest_.detection_from_descriptors) {
      find_descriptor_maxima(engine_.output(OutputRole::kDescriptors), manifest_.descriptor.stride,
                             detector_.score_threshold, candidates_);
    } else {
      scores_ = manifest_.keypoint_logits
                    ? cells_.log_probabilities(engine_.output(OutputRole::kKeypointLogits))
                    : engine_.output(OutputRole::kScores);
      if (detector_.nms_iterations == 0 && detector_.nms_radius > 0) {
        find_maxima(scores_, threshold(), area, detector_.nms_radius, candidates_);
        return;
      }
      dxslam::find_candidates(scores_, threshold(), candidates_);
    }
    suppression_.run(size.width, size.height, detector_.nms_radius, detector_.nms_iterations,
                     candidates_);
    candidates_.erase(std::remove_if(candidates_.begin(), candidates_.end(),
                                     [&](const Candidate& c) { return !area.contains(c.x, c.y); }),
                      candidates_.end());
  }

  /// In units of the score map: log probabilities, logits or probabilities.
  float threshold() const {
    const double threshold = std::max(detector_.score_threshold, kLowestScore);
    if (manifest_.keypoint_logits) return static_cast<float>(std::log(threshold));
    return detector_.sigmoid ? logit(threshold) : static_cast<float>(threshold);
  }

  /// Keeps the best; from here on scores are those that keypoints carry.
  void select(const cv::Size& size) {
    if (manifest_.reliability) weigh_by_reliability();
    select_keypoints(size.width, size.height, detector_.max_keypoints, detector_.spread,
                     detector_.spread_cell, candidates_);
  }

  void weigh_by_reliability() {
    const TensorView map = engine_.output(OutputRole::kReliability);
    const SamplingGrid grid = sampling_grid();
    for (Candidate& c : candidates_) {
      const cv::Point2f position(static_cast<float>(c.x), static_cast<float>(c.y));
      const float reliability = std::max(sample_value(map, grid, position), 1e-12F);
      if (manifest_.keypoint_logits) {
        c.score += std::log(reliability);
      } else {
        c.score *= reliability;
      }
    }
  }

  SamplingGrid sampling_grid() const {
    return {manifest_.descriptor.stride, manifest_.descriptor.align_corners};
  }

  float final_score(float score) const {
    if (manifest_.keypoint_logits) return std::exp(score);
    return detector_.sigmoid ? sigmoid(score) : score;
  }

  /// Sub-pixel positions in the network's input, a candidate.
  std::vector<cv::Point2f> positions() const {
    std::vector<cv::Point2f> result;
    result.reserve(candidates_.size());
    const bool refine = detector_.subpixel && !manifest_.detection_from_descriptors;
    const bool is_log = manifest_.keypoint_logits || detector_.sigmoid;
    const auto log_score = [&](int x, int y) {
      const float score = *scores_.at(y, x);
      return is_log ? score : std::log(std::max(score, static_cast<float>(kLowestScore)));
    };
    for (const Candidate& c : candidates_) {
      const cv::Point2f offset = refine ? peak_offset(log_score, c.x, c.y) : cv::Point2f(0, 0);
      result.emplace_back(static_cast<float>(c.x) + offset.x, static_cast<float>(c.y) + offset.y);
    }
    return result;
  }

  Features describe() {
    Features features;
    const std::vector<cv::Point2f> places = positions();
    features.descriptors =
        sample_descriptors(engine_.output(OutputRole::kDescriptors), sampling_grid(), places);
    features.keypoints.reserve(candidates_.size());
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      const cv::Point2f p = input_.to_image(places[i]);
      features.keypoints.push_back({p.x, p.y, final_score(candidates_[i].score), input_.sigma()});
    }
    features.global = engine_.global();
    normalize(features.global);
    return features;
  }

  ModelManifest manifest_;
  DetectorOptions detector_;
  DescriptorTraits traits_;
  OpenVinoEngine engine_;
  NetworkInput input_;
  CellScores cells_;
  TensorView scores_;  // of the last image; in cells_ or engine_
  NonMaximumSuppression suppression_;
  std::vector<Candidate> candidates_;
  StageTimer timer_;
  bool keeps_encoder_ = false;
};

}  // namespace

std::unique_ptr<FeatureExtractor> make_network_extractor(const ModelManifest& manifest,
                                                         const ExtractorOptions& options) {
  return std::make_unique<NetworkExtractor>(manifest, options);
}

}  // namespace dxslam
