// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/backend.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <unordered_map>

#include "core/error.h"

namespace dxslam {
namespace {

LoopSearch make_search(const SystemOptions& options, const FeatureExtractor& extractor) {
  if (!options.close_loops) return {{}, 1.0, "", "", {}};
  return {options.loop_detection, options.loop_relaxation,
          find_vocabulary(options.vocabulary, extractor.name()), extractor.name(),
          extractor.traits()};
}

}  // namespace

Backend::Backend(const Camera& camera, FeatureExtractor& extractor, const SystemOptions& options,
                 const Pause& pause)
    : options_(options),
      extractor_(extractor),
      mapper_(camera, extractor.traits(), options.mapping, pause),
      search_(make_search(options, extractor)),
      closer_(extractor.traits(), options.loop_closing, options.deterministic, pause),
      relocalizer_(camera, extractor.traits(), options.relocalization),
      consensus_(options.relocalization.consensus) {}

void Backend::load(Map map, std::vector<LoopEdge> closed_loops) {
  require(mapper_.map().keyframe_count() == 0, "a map can only be loaded in place of an empty one");
  mapper_.set_map(std::move(map));
  closer_.set_closed_loops(std::move(closed_loops));
  index_ = index_keyframes(mapper_.map());
  search_.add_later(mapper_.map().keyframe_ids());
}

std::vector<float> Backend::global_of(const Frame& frame) {
  if (!frame.global.empty() || frame.encoder.empty()) return frame.global;
  return extractor_.global_of(frame.encoder);
}

FramePtr Backend::keyframe_of(const Frame& frame) {
  auto copy = std::make_shared<Frame>(frame);
  copy->camera = mapper_.camera_id();
  copy->global = global_of(frame);
  copy->encoder.release();
  return copy;
}

LocalMapPtr Backend::insert(const KeyframeRequest& request) {
  KeyframeRequest kept = request;
  kept.frame = keyframe_of(*request.frame);
  report_ = mapper_.insert(kept);
  grown_ = true;
  if (!kept.frame->global.empty()) index_.add(report_.keyframe, kept.frame->global);
  return mapper_.local_map();
}

LocalMapPtr Backend::refine() {
  mapper_.refine(report_);
  for (const KeyframeId id : report_.culled_keyframes) {
    index_.remove(id);
    search_.remove(id);
  }
  return mapper_.local_map();
}

LocalMapPtr Backend::close_loops() {
  bool moved = closer_.poll(mapper_.map()).has_value();
  if (search_.usable()) {
    std::vector<LoopCandidate> candidates = search_.search(mapper_.map(), report_.keyframe);
    if (!candidates.empty() && !candidates.front().accepted()) candidates.clear();
    std::vector<KeyframeId> ids;
    for (const LoopCandidate& c : candidates) ids.push_back(c.id);
    const LoopReport report = closer_.consider(mapper_.map(), report_.keyframe, ids);
    record(report, candidates);
    moved = moved || report.effect != LoopEffect::kNone;
  }
  return moved ? mapper_.local_map() : nullptr;
}

void Backend::record(const LoopReport& report, const std::vector<LoopCandidate>& candidates) {
  for (std::size_t i = 0; i < report.attempts.size(); ++i) {
    const LoopAttempt& attempt = report.attempts[i];
    LoopRecord record;
    record.frame = mapper_.map().keyframe(report.query).frame->index;
    record.query = report.query;
    record.candidate = attempt.verification.candidate;
    const auto found =
        std::find_if(candidates.begin(), candidates.end(),
                     [&](const LoopCandidate& c) { return c.id == record.candidate; });
    if (found != candidates.end()) {
      record.bow_score = found->bow_score;
      record.global_distance = found->global_distance;
    }
    record.accepted = attempt.plan.effect != LoopEffect::kNone;
    record.verdict = attempt.verdict();
    record.effect = describe(attempt.plan.effect);
    record.inliers = attempt.verification.inliers;
    record.found_share = attempt.verification.found_share;
    record.covered_share = attempt.verification.covered_share;
    record.confirmations = attempt.verification.confirmations;
    record.contradiction = attempt.plan.contradiction;
    if (record.accepted) record.largest_move = report.change.largest_move;
    if (attempt.plan.effect == LoopEffect::kJoin) {
      record.joined = {attempt.plan.kept_component, attempt.plan.joined_component};
    }
    loop_log_.add(std::move(record));
  }
}

LocalMapPtr Backend::follow(const KeyframeRequest& request) {
  std::unordered_map<KeyframeId, int> shared;
  for (const PointId id : request.points) {
    if (!map().has_point(id)) continue;
    for (const PointObservation& o : map().point(id).observations) ++shared[o.keyframe];
  }
  KeyframeId best = map().anchor_of(request.reference).keyframe;
  shared.try_emplace(best, 0);
  for (const auto& [id, count] : shared) {
    const int most = shared.at(best);
    if (count > most || (count == most && id < best)) best = id;
  }
  return mapper_.local_map_around(best);
}

RelocalizationAnswer Backend::relocalize(const Frame& frame) {
  Frame asking = frame;
  asking.global = global_of(frame);
  RelocalizationAnswer answer;
  answer.report = relocalizer_.relocalize(map(), index_, asking);
  if (auto agreed = consensus_.add(frame.stamp, answer.report)) {
    answer.report = std::move(*agreed);
    answer.local_map = mapper_.local_map_around(answer.report.reference);
  }
  return answer;
}

void Backend::finish(const MayGoOn& may_go_on, const MapChange& change) {
  if (!grown_) return;
  if (options_.final_bundle && map().keyframe_count() > 1) {
    closer_.cancel();
    if (!must_stop(may_go_on)) {
      mapper_.adjust_full_bundle(options_.full_bundle, may_go_on, change);
    }
    return;
  }
  bool arrived = false;
  const auto poll = [&] { arrived = closer_.poll(mapper_.map()).has_value(); };
  for (change(poll); !arrived && closer_.bundle_pending(); change(poll)) {
    if (must_stop(may_go_on)) closer_.cancel();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

}  // namespace dxslam
