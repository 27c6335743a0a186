// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/recording_report.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stop_token>
#include <utility>

#include "apps/commands.h"
#include "apps/console.h"
#include "apps/failure.h"
#include "apps/process.h"
#include "apps/statistics_json.h"
#include "core/error.h"
#include "evaluation/ate.h"

namespace dxslam::apps {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kWrongScale = 0.1;
// The path tells scale only if it shrinks the error as well; a short path fits at any scale.
constexpr double kExplained = 0.7;
constexpr double kLeastExtent = 0.3;  // metres; an error of some cm is no matter of scale

// Of the box around the true positions.
double extent_of(const std::vector<PosePair>& pairs) {
  Eigen::AlignedBox3d box;
  for (const PosePair& pair : pairs) box.extend(pair.truth.world_from_camera.translation());
  return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

}  // namespace

void print_recording(const ImageOrigin& recording) {
  const Camera& c = recording.camera();
  const RecordingFacts& facts = recording.facts();
  warn("camera of {}: {}x{}, fx {:.1f}, fy {:.1f}, cx {:.1f}, cy {:.1f}{}",
       facts.calibration_source, c.width, c.height, c.fx, c.fy, c.cx, c.cy,
       c.has_distortion() ? fmt::format(", lens {}", c.lens.model->name) : "");
  if (!facts.has_depth) return;
  if (facts.depth_share == 0.0) {
    warn("depth: {:g} units per metre, no reading in the first images", c.depth_factor);
    return;
  }
  warn("depth: {:g} units per metre, median {:.2f} m in the first images, {:.0f} % of their pixels",
       c.depth_factor, facts.median_depth, 100.0 * facts.depth_share);
}

SkippedFrame skipped_for(std::size_t index, const std::exception& error) {
  const Failure failure = failure_of(error);
  std::string reason = failure.code == kBadInput ? failure.sentence : error.what();
  while (!reason.empty() && reason.back() == '\n') reason.pop_back();  // OpenCV's end so
  return {index, reason};
}

std::optional<SkippedFrame> ImageAttempts::attempt(std::size_t index,
                                                   const std::function<void()>& work) {
  SkippedFrame skipped;
  try {
    work();
    has_worked_ = true;
    return std::nullopt;
  } catch (const std::exception& e) {
    skipped = skipped_for(index, e);
  }
  if (has_worked_) return skipped;
  if (failures_++ == 0) reason_ = skipped.reason;
  has_worked_ = skipped.reason != reason_;
  if (failures_ < kAlike || has_worked_) return skipped;
  throw InputError(
      fmt::format("none of the first {} images can be worked on: {}", failures_, reason_));
}

std::optional<RgbdImage> next_image(ImageSource& source, std::vector<SkippedFrame>& failed,
                                    const std::function<void(const SkippedFrame&)>& tell) {
  const std::stop_callback ends(stop_token(), [&source] { source.stop(); });
  while (!stop_requested()) {
    const std::size_t told = source.skipped().size();
    std::optional<SkippedFrame> failure;
    std::optional<RgbdImage> image;
    try {
      image = source.next();
    } catch (const InputError&) {
      throw;
    } catch (const std::exception& e) {
      failure = skipped_for(source.index(), e);
    }
    const std::vector<SkippedFrame>& skipped = source.skipped();
    for (std::size_t i = told; tell && i < skipped.size(); ++i) tell(skipped[i]);
    if (!failure) return stop_requested() ? std::nullopt : std::move(image);
    if (tell) tell(*failure);
    failed.push_back(std::move(*failure));
  }
  return std::nullopt;
}

std::vector<SkippedFrame> all_skipped(const ImageOrigin& recording,
                                      const std::vector<SkippedFrame>& failed) {
  std::vector<SkippedFrame> all = recording.skipped();
  all.insert(all.end(), failed.begin(), failed.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.index < b.index; });
  return all;
}

void print_skipped(const std::vector<SkippedFrame>& skipped) {
  if (skipped.empty()) return;
  warn("frames that were skipped: {}; the first, {}: {}", skipped.size(), skipped.front().index,
       skipped.front().reason);
}

Json camera_json(const Camera& c) {
  Json json = {
      {"width", c.width}, {"height", c.height},        {"fx", c.fx}, {"fy", c.fy}, {"cx", c.cx},
      {"cy", c.cy},       {"lens", c.lens.model->name}};
  for (std::size_t i = 0; i < c.lens.model->parameter_count(); ++i) {
    json[c.lens.model->parameters[i]] = c.lens.parameters[i];
  }
  return json;
}

Json recording_json(const ImageOrigin& recording) {
  const RecordingFacts& facts = recording.facts();
  return {{"calibration", facts.calibration_source},
          {"camera", camera_json(recording.camera())},
          {"depth_factor", recording.camera().depth_factor},
          {"median_depth_m", facts.depth_share > 0.0 ? Json(facts.median_depth) : Json(nullptr)},
          {"depth_share", facts.depth_share}};
}

bool TruthReport::scale_is_wrong() const {
  return extent > kLeastExtent && std::abs(std::log(scale)) > std::log1p(kWrongScale) &&
         rmse_with_scale < kExplained * position.rmse;
}

std::optional<TruthReport> compare_with_truth(const ImageOrigin& recording,
                                              const Trajectory& estimate) {
  if (recording.ground_truth().empty() || estimate.empty()) return std::nullopt;
  try {
    const AteReport rigid = evaluate_ate(recording.ground_truth(), estimate);
    const AteReport similar = evaluate_ate(recording.ground_truth(), estimate, {Alignment::kSim3});
    return TruthReport{rigid.position, similar.truth_from_estimate.scale(), similar.position.rmse,
                       extent_of(rigid.pairs),
                       likely_offset(recording.ground_truth(), estimate, rigid.position.rmse)};
  } catch (const InputError& error) {  // no common stamps, or all on one line
    warn("{}: not compared with the true trajectory: {}", recording.name(), error.what());
    return std::nullopt;
  }
}

const char* likely_unit(double scale) {
  constexpr double kNear = 1.25;
  for (const auto& [per_metre, unit] : {std::pair(1000.0, "millimetres"), {100.0, "centimetres"}}) {
    if (scale > per_metre / kNear && scale < per_metre * kNear) return unit;
  }
  return nullptr;
}

void print_truth(const TruthReport& report, const Camera& camera) {
  print("ATE {:.4f} m over {} poses, scale {:.3f} against the truth\n", report.position.rmse,
        report.position.count, report.scale);
  if (report.clock) {
    warn(
        "with {:+.3f} s added to the stamps of the images, the error would be {:.4f} m: do the "
        "clocks of images and truth differ?",
        report.clock->offset, report.clock->rmse);
  }
  if (!report.scale_is_wrong()) return;
  if (const char* unit = likely_unit(report.scale)) {
    warn("the true path is {:.4g} times as long: is it in {}, expected metres?", report.scale,
         unit);
    return;
  }
  warn(
      "the true path is {:.3g} times as long: with a depth_factor of {:.4g} instead of {:g} they "
      "would agree, if the calibration (fx {:.1f}) is right",
      report.scale, camera.depth_factor / report.scale, camera.depth_factor, camera.fx);
}

Json truth_json(const std::optional<TruthReport>& report) {
  if (!report) return nullptr;
  Json json = statistics_json(report->position);
  json["sim3_scale"] = report->scale;
  json["sim3_rmse"] = report->rmse_with_scale;
  return json;
}

}  // namespace dxslam::apps
