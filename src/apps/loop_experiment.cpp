// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/loop_experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <unordered_map>

#include "apps/process.h"
#include "apps/recording_report.h"
#include "core/error.h"
#include "features/data_directory.h"
#include "features/extractor_factory.h"
#include "place/two_view_check.h"
#include "slam/stage_times.h"
#include "synthetic/low_light.h"
#include "vocabulary/vocabulary.h"

namespace dxslam::apps {
namespace {

constexpr double kPoseTolerance = 0.05;  // seconds between a frame and its pose, at most

std::string vocabulary_path(const std::string& given, const std::string& name) {
  if (!given.empty()) return given;
  return (std::filesystem::path(data_directory()) / "models" / "vocabulary" / (name + ".fbow"))
      .string();
}

/// One kind of features: extractor, vocabulary, and what was found in the images so far.
class FeatureSide {
 public:
  FeatureSide(const std::string& name, const ExtractorOptions& options,
              const std::string& vocabulary, bool with_words, bool keep_all)
      : extractor_(make_extractor(name, options)), keep_all_(keep_all) {
    if (!with_words) return;
    const std::string path = vocabulary_path(vocabulary, extractor_->name());
    vocabulary_ = Vocabulary::load(path);
    const DescriptorTraits& traits = extractor_->traits();
    require_words_of(*vocabulary_, path, extractor_->name(), traits.binary, traits.dimension);
  }

  const FeatureExtractor& extractor() const { return *extractor_; }
  std::size_t word_count() const { return vocabulary_ ? vocabulary_->word_count() : 0; }
  const std::vector<double>& extraction_ms() const { return extraction_ms_; }
  double words_ms() const { return words_ms_; }
  const BowVector& bow() const { return bow_; }
  const std::vector<float>& global() const { return now_->global; }

  void extract(const cv::Mat& image, std::uint32_t frame) {
    const Stopwatch extraction;
    now_ = std::make_shared<Features>(extractor_->extract(image, true));
    extraction_ms_.push_back(extraction.ms());
    const Stopwatch quantising;
    if (vocabulary_) bow_ = vocabulary_->transform(now_->descriptors);
    words_ms_ = quantising.ms();
    if (keep_all_) all_[frame] = now_;
  }

  int inliers_with(std::uint32_t frame) const {
    return count_epipolar_inliers(*now_, *all_.at(frame), extractor_->traits());
  }

 private:
  std::unique_ptr<FeatureExtractor> extractor_;
  std::optional<Vocabulary> vocabulary_;
  bool keep_all_;
  std::shared_ptr<const Features> now_;
  BowVector bow_;
  double words_ms_ = 0.0;
  std::vector<double> extraction_ms_;
  std::unordered_map<std::uint32_t, std::shared_ptr<const Features>> all_;
};

/// One method at work.
struct Competitor {
  LoopDetector detector;
  FeatureSide* side;
  MethodRun run;

  void ask(std::uint32_t frame, const PlaceExclusion& excluded) {
    const Stopwatch timer;
    const LoopVerifier verify = [this](std::uint32_t id) { return side->inliers_with(id); };
    LoopQuery query{frame, detector.detect(side->bow(), side->global(), excluded, verify), 0.0};
    query.ms = timer.ms() + (detector.method().words ? side->words_ms() : 0.0);
    run.queries.push_back(std::move(query));
  }
};

class Experiment {
 public:
  explicit Experiment(const LoopSettings& settings) : settings_(settings) {
    for (const std::string& name : settings.methods) methods_.push_back(parse_loop_method(name));
    make_side(true, orb_);
    make_side(false, hf_);
    for (const LoopMethod& method : methods_) {
      LoopDetectorOptions options = settings.detector;
      options.method = method.name;
      FeatureSide* side = (method.orb ? orb_ : hf_).get();
      if (method.global && side->extractor().traits().global_dimension == 0) {
        throw InputError(fmt::format("extractor {} has no global descriptor, expected one for {}",
                                     side->extractor().name(), method.name));
      }
      contestants_.push_back({LoopDetector(options), side, {options, 0, {}}});
      contestants_.back().run.words = method.words ? side->word_count() : 0;
    }
  }

  void extract(const cv::Mat& image, std::uint32_t frame) {
    if (orb_) orb_->extract(image, frame);
    if (hf_) hf_->extract(image, frame);
  }

  /// The frame extracted last.
  void ask(std::uint32_t frame, const PlaceExclusion& excluded) {
    const bool two_passes = settings_.second_pass_from.has_value();
    const bool second = two_passes && frame >= *settings_.second_pass_from;
    if (!two_passes || second) {
      result_.queries.push_back(frame);
      for (Competitor& contestant : contestants_) contestant.ask(frame, excluded);
    }
    if (second) return;
    result_.places.push_back(frame);
    for (Competitor& c : contestants_) c.detector.add(frame, c.side->bow(), c.side->global());
  }

  LoopExperiment take_result() {
    for (Competitor& contestant : contestants_) {
      result_.runs.push_back(std::move(contestant.run));
    }
    if (hf_) result_.hf_name = hf_->extractor().name();
    if (hf_) result_.hf_ms = hf_->extraction_ms();
    if (orb_) result_.orb_ms = orb_->extraction_ms();
    return std::move(result_);
  }

 private:
  // Of the features that methods on this side need, if there are any.
  void make_side(bool orb, std::unique_ptr<FeatureSide>& side) const {
    bool wanted = false;
    bool words = false;
    bool geometry = false;
    for (const LoopMethod& method : methods_) {
      if (method.orb != orb) continue;
      wanted = true;
      words = words || method.words;
      geometry = geometry || method.geometry;
    }
    if (!wanted) return;
    const std::string name = orb                          ? std::string("orb")
                             : settings_.features.empty() ? choose_extractor().name
                                                          : settings_.features;
    side = std::make_unique<FeatureSide>(name, settings_.extractor,
                                         orb ? settings_.orb_vocabulary : settings_.hf_vocabulary,
                                         words, geometry);
  }

  const LoopSettings& settings_;
  std::vector<LoopMethod> methods_;
  std::unique_ptr<FeatureSide> orb_;
  std::unique_ptr<FeatureSide> hf_;
  std::vector<Competitor> contestants_;
  LoopExperiment result_;
};

/// The pose of a moment; nothing if none is near enough in time.
const StampedPose* pose_at(const Trajectory& truth, double stamp) {
  if (truth.empty()) return nullptr;
  auto nearest =
      std::lower_bound(truth.begin(), truth.end(), stamp,
                       [](const StampedPose& pose, double value) { return pose.stamp < value; });
  if (nearest == truth.end() ||
      (nearest != truth.begin() && stamp - std::prev(nearest)->stamp < nearest->stamp - stamp)) {
    --nearest;
  }
  return std::abs(nearest->stamp - stamp) <= kPoseTolerance ? &*nearest : nullptr;
}

LoopTruth truth_from_poses(const LoopSettings& settings, const RgbdSequence& sequence,
                           const std::vector<std::optional<DepthView>>& views) {
  Trajectory poses;
  std::vector<std::size_t> frames;
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    const StampedPose* pose = pose_at(sequence.ground_truth(), sequence.stamp(i));
    if (pose == nullptr) continue;
    poses.push_back({sequence.stamp(i), pose->world_from_camera});
    frames.push_back(i);
  }
  LoopTruth truth = loop_truth_from_poses(poses, frames, sequence.size(), settings.poses);
  mark_overlapping_views(views, settings.poses, truth);
  return truth;
}

// Frames 2k and 2k + 1 are the two views of place k; these two of each other say nothing.
LoopTruth two_views_per_place(const LoopTruth& places) {
  LoopTruth truth(2 * places.frames());
  for (std::size_t i = 0; i < truth.frames(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const PairTruth pair = i / 2 == j / 2 ? PairTruth::kUnclear : places.at(i / 2, j / 2);
      if (pair != PairTruth::kDifferent) truth.set(i, j, pair);
    }
  }
  return truth;
}

}  // namespace

LoopExperiment run_loop_experiment(const LoopSettings& settings, RgbdSequence& sequence,
                                   const std::function<void(std::size_t, std::size_t)>& progress) {
  Experiment experiment(settings);
  const LowLight low_light(settings.low_light_gain > 0.0 ? settings.low_light_gain
                                                         : LowLight::kDefaultGain);
  std::vector<std::optional<DepthView>> views(sequence.size());
  std::vector<SkippedFrame> failed;
  ImageAttempts attempts;
  bool interrupted = false;
  std::size_t total = (sequence.size() + settings.stride - 1) / settings.stride;
  if (settings.max_frames > 0) total = std::min(total, settings.max_frames);
  for (std::size_t k = 0; k < total; ++k) {
    const std::size_t i = k * settings.stride;
    progress(k + 1, total);
    bool extracted = false;
    const auto failure = attempts.attempt(i, [&] {
      std::optional<RgbdImage> image = sequence.read(i);
      if (!image || stop_requested()) return;
      if (settings.low_light_from && i >= *settings.low_light_from) {
        image->color = low_light.apply(image->color, image->index);
      }
      const StampedPose* pose = pose_at(sequence.ground_truth(), sequence.stamp(i));
      if (pose != nullptr && !image->depth.empty()) {
        views[i].emplace(image->depth, sequence.camera(), pose->world_from_camera);
      }
      experiment.extract(image->color, static_cast<std::uint32_t>(i));
      extracted = true;
    });
    if (failure) failed.push_back(*failure);
    interrupted = stop_requested();
    if (interrupted) break;
    if (!extracted) continue;
    const double latest = sequence.stamp(i) - settings.poses.window;
    experiment.ask(static_cast<std::uint32_t>(i),
                   [&](std::uint32_t place) { return sequence.stamp(place) > latest; });
  }
  LoopExperiment result = experiment.take_result();
  result.failed = std::move(failed);
  result.interrupted = interrupted;
  result.views = std::move(views);
  return result;
}

LoopTruth load_loop_truth(const LoopSettings& settings, const RgbdSequence& sequence,
                          const std::vector<std::optional<DepthView>>& views) {
  if (settings.truth == "poses") return truth_from_poses(settings, sequence, views);
  LoopTruth truth = read_loop_truth(settings.truth);
  const std::size_t frames = sequence.size();
  if (truth.frames() == frames) return truth;
  if (settings.reader.eye != "all") {
    LoopTruth part = every_nth(truth, settings.reader.eye == "right" ? 1 : 0, 2);
    if (part.frames() == frames) return part;
  } else if (frames == 2 * truth.frames()) {
    return two_views_per_place(truth);
  }
  throw InputError(fmt::format("{}: true loops of {} frames, expected {} as the recording has",
                               settings.truth, truth.frames(), frames));
}

}  // namespace dxslam::apps
