// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "relocalization/consensus.h"

namespace dxslam::benchmark {
namespace {

constexpr double kWrong = 0.5;  // metres; an accepted pose farther off is plainly wrong

// Asks for the global descriptor of every image, so that all keyframes have one.
class GlobalToo : public FeatureExtractor {
 public:
  explicit GlobalToo(FeatureExtractor& extractor) : extractor_(extractor) {}
  const std::string& name() const override { return extractor_.name(); }
  const DescriptorTraits& traits() const override { return extractor_.traits(); }
  Features extract(const cv::Mat& image, bool) override { return extractor_.extract(image, true); }

 private:
  FeatureExtractor& extractor_;
};

// Time that this thread had a processor: what the wall clock would say on an idle machine.
double processor_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

// Images of other cameras are brought to the size of this one.
RgbdImage fitted(const RgbdImage& image, const Camera& camera) {
  RgbdImage fit = image;
  const cv::Size size(camera.width, camera.height);
  if (image.color.size() != size) cv::resize(image.color, fit.color, size, 0, 0, cv::INTER_AREA);
  if (!image.depth.empty() && image.depth.size() != size) {
    cv::resize(image.depth, fit.depth, size, 0, 0, cv::INTER_NEAREST);
  }
  return fit;
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1) + 0.5)];
}

}  // namespace

MapUnderTest::MapUnderTest(RgbdSequence& sequence, std::unique_ptr<FeatureExtractor> extractor,
                           const Picker& in_map, double right_distance)
    : sequence_(sequence), extractor_(std::move(extractor)) {
  SystemOptions options;
  options.deterministic = true;  // the order of steps alone: the network computes as it is shipped
  system_ = std::make_unique<System>(sequence.camera(), std::make_unique<GlobalToo>(*extractor_),
                                     options);
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    if (!in_map(i, sequence)) continue;
    const std::optional<RgbdImage> image = sequence.read(i);
    if (!image) continue;
    system_->process(*image);
    true_map_poses_.push_back(sequence.ground_truth()[i]);
  }
  system_->finish();
  index_ = index_keyframes(map());
  pairs_ = associate_or_throw(true_map_poses_, system_->trajectory(), 0.01);
  alignment_ = align_poses(pairs_, right_distance, 5.0);
  alignment_with_offset_ = align_with_camera_offset(pairs_);
}

std::vector<Deviation> MapUnderTest::own_deviations(const MapAlignment& alignment) const {
  std::vector<Deviation> deviations;
  for (const PosePair& pair : pairs_) {
    deviations.push_back(deviation(alignment.aligned(pair.estimate.world_from_camera),
                                   pair.truth.world_from_camera));
  }
  return deviations;
}

SE3 MapUnderTest::true_pose(double stamp) const {
  const auto it = std::min_element(true_map_poses_.begin(), true_map_poses_.end(),
                                   [&](const StampedPose& a, const StampedPose& b) {
                                     return std::abs(a.stamp - stamp) < std::abs(b.stamp - stamp);
                                   });
  require(it != true_map_poses_.end(), "a map under test has frames");
  return it->world_from_camera;
}

Outcome locate(MapUnderTest& map, const Relocalizer& relocalizer, const Query& query) {
  return locate(map, map.map(), map.index(), relocalizer, query);
}

Outcome locate(MapUnderTest& map, const Map& searched, const GlobalIndex& index,
               const Relocalizer& relocalizer, const Query& query) {
  const RgbdImage image = fitted(query.image, map.camera());
  const FramePtr frame =
      make_frame(image, map.extractor().extract(image.color, true), map.camera());
  Outcome outcome;
  outcome.stamp = query.image.stamp;
  const double before = processor_ms();
  outcome.report = relocalizer.relocalize(searched, index, *frame);
  outcome.ms = processor_ms() - before;
  outcome.elsewhere = !query.truth_from_camera;
  if (outcome.elsewhere || !outcome.report.has_pose) return outcome;
  const SE3& truth = *query.truth_from_camera;
  const SE3 pose = outcome.report.world_from_camera * query.turned_from_camera;
  outcome.global = deviation(map.alignment().aligned(pose), truth);
  outcome.with_offset = deviation(map.alignment_with_offset().aligned(pose), truth);
  const Keyframe& reference = searched.keyframe(outcome.report.reference);
  const SE3 expected = map.true_pose(reference.frame->stamp).inverse() * truth;
  outcome.local = deviation(reference.world_from_camera.inverse() * pose, expected);
  return outcome;
}

void print_heading() {
  fmt::print(
      "| queries | number | accepted | right | right, with camera offset | right, relative to the "
      "keyframe | wrong | by three in a row | of these wrong | median error, with offset | p95 | "
      "ms: median | p95 | groups |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

Agreement agreement(const Row& row) {
  RelocalizationConsensus consensus;
  Agreement found;
  for (const Outcome& o : row.outcomes) {
    const std::optional<RelocalizationReport> taken = consensus.add(o.stamp, o.report);
    if (!taken || o.report.accepted) continue;
    ++found.accepted;
    if (o.elsewhere || o.global.distance > kWrong) ++found.wrong;
  }
  return found;
}

void print_row(const Row& row) {
  int accepted = 0, right = 0, with_offset = 0, local = 0, wrong = 0, groups = 0;
  std::vector<double> distances, angles, times;
  for (const Outcome& o : row.outcomes) {
    times.push_back(o.ms);
    groups += o.report.groups_tried;
    if (!o.report.accepted) continue;
    ++accepted;
    if (o.elsewhere || o.global.distance > kWrong) ++wrong;
    if (o.elsewhere) continue;
    distances.push_back(o.with_offset.distance);
    angles.push_back(o.with_offset.angle);
    right += o.global.within(row.right_distance, row.right_angle) ? 1 : 0;
    with_offset += o.with_offset.within(row.right_distance, row.right_angle) ? 1 : 0;
    local += o.local.within(row.right_distance, row.right_angle) ? 1 : 0;
  }
  const double n = static_cast<double>(std::max<std::size_t>(1, row.outcomes.size()));
  fmt::print("| {} | {} | {:.1f} % | {:.1f} % | {:.1f} % | {:.1f} % | {} | {} | {} | ", row.name,
             row.outcomes.size(), 100.0 * accepted / n, 100.0 * right / n, 100.0 * with_offset / n,
             100.0 * local / n, wrong, agreement(row).accepted, agreement(row).wrong);
  if (distances.empty()) {
    fmt::print("- | - | ");
  } else {
    fmt::print("{:.3f} m, {:.2f}° | {:.3f} m, {:.2f}° | ", quantile(distances, 0.5),
               quantile(angles, 0.5), quantile(distances, 0.95), quantile(angles, 0.95));
  }
  fmt::print("{:.1f} | {:.1f} | {:.2f} |\n", quantile(times, 0.5), quantile(times, 0.95),
             groups / n);
  std::fflush(stdout);
}

void append_csv(const std::string& path, const Row& row) {
  if (path.empty()) return;
  const bool fresh = !std::filesystem::exists(path);
  std::ofstream file(path, std::ios::app);
  if (fresh) {
    file << "row,query,elsewhere,has_pose,accepted,confidence,matches,matched,visible,coverage,"
            "inliers,"
            "spread,rms,groups,distance,angle,offset_distance,offset_angle,local_distance,"
            "local_angle,ms\n";
  }
  for (std::size_t i = 0; i < row.outcomes.size(); ++i) {
    const Outcome& o = row.outcomes[i];
    const RelocalizationReport& r = o.report;
    file << fmt::format(
        "{},{},{:d},{:d},{:d},{:.4f},{},{},{},{:.3f},{},{:.4f},{:.3f},{},{:.4f},{:.3f},{:.4f},{:."
        "3f},"
        "{:.4f},{:.3f},{:.2f}\n",
        row.name, i, o.elsewhere, r.has_pose, r.accepted, r.confidence, r.matches, r.matched,
        r.visible, r.coverage, r.inliers, r.spread, r.rms_pixels, r.groups_tried, o.global.distance,
        o.global.angle, o.with_offset.distance, o.with_offset.angle, o.local.distance,
        o.local.angle, o.ms);
  }
}

}  // namespace dxslam::benchmark
