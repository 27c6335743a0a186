// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "loop_closing/background_bundle.h"

#include <algorithm>
#include <ranges>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "core/parallel.h"

namespace dxslam {
namespace {

// A keyframe with fewer observations in the bundle is held better by its parent.
constexpr int kMinObservations = 10;

class BundleMerger {
 public:
  BundleMerger(const LocalBundle& bundle, const BundleReport& report, Map& map)
      : bundle_(bundle), report_(report), map_(map) {}

  BundleMerge run() {
    merge_.iterations = report_.iterations;
    merge_.initial_cost = report_.initial_cost;
    merge_.final_cost = report_.final_cost;
    if (!report_.usable) return merge_;
    merge_.merged = true;
    collect_adjusted();
    for (const KeyframeId id : map_.keyframe_ids()) place(id);
    place_points();
    for (const auto& [id, after] : after_) map_.set_pose(id, after);
    unbind_outliers();
    for (const PointId id : moved_points_) {
      if (map_.has_point(id)) map_.refresh_point(id);
    }
    return merge_;
  }

 private:
  void collect_adjusted() {
    std::vector<int> observations(bundle_.keyframes.size(), 0);
    for (std::size_t i = 0; i < report_.inlier.size(); ++i) {
      if (report_.inlier[i] == 0) continue;
      ++observations[static_cast<std::size_t>(bundle_.problem.observations[i].pose)];
    }
    for (std::size_t i = 0; i < bundle_.keyframes.size(); ++i) {
      const KeyframeId id = bundle_.keyframes[i];
      if (!map_.has_keyframe(id)) continue;
      const bool held = bundle_.problem.poses[i].fixed;
      if (!held && observations[i] < kMinObservations) continue;
      after_[id] = bundle_.problem.poses[i].world_from_camera;
      if (!held) ++merge_.adjusted_keyframes;
    }
  }

  // Where a keyframe goes; its parents first. A component that was not adjusted stays.
  void place(KeyframeId id) {
    std::vector<KeyframeId> chain;
    while (after_.count(id) == 0) {
      const Keyframe& k = map_.keyframe(id);
      if (k.parent == kNoId) {
        after_[id] = k.world_from_camera;
        break;
      }
      chain.push_back(id);
      id = k.parent;
    }
    for (const KeyframeId child : chain | std::views::reverse) {
      const Keyframe& k = map_.keyframe(child);
      const Keyframe& parent = map_.keyframe(k.parent);
      if (unmoved(parent)) {
        after_[child] = k.world_from_camera;
        continue;
      }
      const SE3 parent_from_camera = parent.world_from_camera.inverse() * k.world_from_camera;
      after_[child] = after_.at(parent.id) * parent_from_camera;
      ++merge_.carried_keyframes;
    }
  }

  bool unmoved(const Keyframe& k) const {
    const SE3& after = after_.at(k.id);
    return after.translation() == k.world_from_camera.translation() &&
           after.rotation().coeffs() == k.world_from_camera.rotation().coeffs();
  }

  // Before the poses are set, since points are carried from the old ones to the new ones.
  void place_points() {
    std::unordered_set<PointId> adjusted;
    for (std::size_t i = 0; i < bundle_.points.size(); ++i) {
      const PointId id = bundle_.points[i];
      if (!map_.has_point(id)) continue;
      adjusted.insert(id);
      moved_points_.push_back(id);
      map_.set_position(id, bundle_.problem.points[i]);
    }
    merge_.adjusted_points = static_cast<int>(adjusted.size());
    for (const PointId id : map_.point_ids()) {
      if (adjusted.count(id) != 0) continue;
      const MapPoint& p = map_.point(id);
      const Keyframe& reference = map_.keyframe(map_.anchor_of(p.created_by).keyframe);
      if (unmoved(reference)) continue;
      map_.set_position(
          id, after_.at(reference.id) * (reference.world_from_camera.inverse() * p.position));
      moved_points_.push_back(id);
      ++merge_.carried_points;
    }
  }

  void unbind_outliers() {
    for (std::size_t i = 0; i < report_.inlier.size(); ++i) {
      if (report_.inlier[i] != 0) continue;
      const BundleProblem::Observation& o = bundle_.problem.observations[i];
      const PointId point = bundle_.points[static_cast<std::size_t>(o.point)];
      const KeyframeId keyframe = bundle_.keyframes[static_cast<std::size_t>(o.pose)];
      if (!map_.has_point(point) || !map_.has_keyframe(keyframe)) continue;
      const std::vector<PointObservation>& seen = map_.point(point).observations;
      const auto it = std::find_if(seen.begin(), seen.end(), [&](const PointObservation& s) {
        return s.keyframe == keyframe;
      });
      if (it == seen.end()) continue;
      // Another keypoint may stand for the point there by now.
      const Frame& frame = *map_.keyframe(keyframe).frame;
      if (frame.pixels[it->keypoint].cast<double>() != o.measured.pixel) continue;
      map_.remove_observation(point, keyframe);
      ++merge_.outlier_observations;
    }
  }

  const LocalBundle& bundle_;
  const BundleReport& report_;
  Map& map_;
  BundleMerge merge_;
  std::unordered_map<KeyframeId, SE3> after_;
  std::vector<PointId> moved_points_;
};

}  // namespace

BundleMerge merge_bundle(const LocalBundle& bundle, const BundleReport& report, Map& map) {
  return BundleMerger(bundle, report, map).run();
}

BackgroundBundle::BackgroundBundle(const BundleOptions& options, bool in_line, Pause pause)
    : options_(options), in_line_(in_line), pause_(std::move(pause)) {}

BackgroundBundle::~BackgroundBundle() {
  cancel();
  for (const std::unique_ptr<Job>& job : cancelled_) job->thread.join();
}

void BackgroundBundle::start(const Map& map, std::uint32_t component) {
  cancel();
  auto job = std::make_unique<Job>();
  job->bundle = gather_component_bundle(map, component);
  const auto work = [this, target = job.get()] { adjust(*target); };
  if (!in_line_) job->thread = thread_if_possible(work);
  if (!job->thread.joinable()) work();
  job_ = std::move(job);
}

void BackgroundBundle::adjust(Job& job) const {
  const auto may_go_on = [&job, pause = pause_] {
    if (pause) pause();
    return !job.stop.load(std::memory_order_relaxed);
  };
  try {
    job.report = adjust_bundle(job.bundle.problem, options_, may_go_on);
  } catch (...) {
    job.error = std::current_exception();
  }
  job.done.store(true, std::memory_order_release);
}

std::optional<BundleMerge> BackgroundBundle::poll(Map& map) {
  if (!job_ || !job_->done.load(std::memory_order_acquire)) return std::nullopt;
  return wait(map);
}

std::optional<BundleMerge> BackgroundBundle::wait(Map& map) {
  if (!job_) return std::nullopt;
  const std::unique_ptr<Job> job = std::move(job_);
  if (job->thread.joinable()) job->thread.join();
  if (job->error) std::rethrow_exception(job->error);
  return merge_bundle(job->bundle, job->report, map);
}

void BackgroundBundle::cancel() {
  bury_dead();
  if (!job_) return;
  job_->stop.store(true, std::memory_order_relaxed);
  if (job_->thread.joinable()) cancelled_.push_back(std::move(job_));
  job_.reset();
}

void BackgroundBundle::bury_dead() {
  const auto ended = [](const std::unique_ptr<Job>& job) {
    if (!job->done.load(std::memory_order_acquire)) return false;
    job->thread.join();
    return true;
  };
  cancelled_.erase(std::remove_if(cancelled_.begin(), cancelled_.end(), ended), cancelled_.end());
}

}  // namespace dxslam
