// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "io/recordings/listed_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "io/primitives/image_file.h"
#include "io/recordings/depth_survey.h"
#include "io/recordings/stamp_hint.h"

namespace dxslam {
namespace {

constexpr std::size_t kProbed = 3;  // frames decoded at opening
constexpr std::size_t kProbeAttempts = 10;
constexpr double kOffCentre = 0.2;  // share of the image's side

class ListedSequence : public RgbdSequence {
 public:
  explicit ListedSequence(SequenceListing listing)
      : listing_(std::move(listing)), skipped_(listing_.skipped) {
    facts_.calibration_source = listing_.calibration_source;
    facts_.truth_problem = listing_.truth_problem;
    facts_.notes = listing_.notes;
    facts_.has_depth = std::any_of(listing_.frames.begin(), listing_.frames.end(),
                                   [](const ListedFrame& frame) { return !frame.depth.empty(); });
  }

  const std::string& name() const override { return listing_.name; }
  const Camera& camera() const override { return listing_.camera; }
  const RecordingFacts& facts() const override { return facts_; }
  std::size_t size() const override { return listing_.frames.size(); }
  double stamp(std::size_t index) const override {
    require(index < size(), "frame index beyond the sequence");
    return listing_.frames[index].stamp;
  }
  const std::vector<SkippedFrame>& skipped() const override { return skipped_; }
  const Trajectory& ground_truth() const override { return listing_.ground_truth; }

  std::optional<RgbdImage> read(std::size_t index) override {
    require(index < size(), "frame index beyond the sequence");
    try {
      return decode(index);
    } catch (const InputError& e) {
      skipped_.push_back({index, e.what()});
      return std::nullopt;
    }
  }

  // Throws the first frame's error if no probed frame can be read.
  void probe() {
    std::vector<cv::Mat> depths;
    std::string first_error;
    for (const std::size_t i : probe_order(size())) {
      if (depths.size() >= kProbed || (!depths.empty() && i >= kProbeAttempts)) break;
      try {
        depths.push_back(decode(i).depth);
      } catch (const InputError& e) {
        if (first_error.empty()) first_error = e.what();
      }
    }
    if (depths.empty()) throw InputError(where() + first_error);
    survey_depths(depths, facts_);
    check_depth_scale(listing_.name, listing_.camera, facts_);
  }

 private:
  // Files name themselves, pictures of a bag only their topic.
  std::string where() const { return listing_.load_color ? listing_.name + ": " : ""; }

  RgbdImage decode(std::size_t index) const {
    const ListedFrame& files = listing_.frames[index];
    RgbdImage image;
    image.index = static_cast<std::int64_t>(index);
    image.stamp = files.stamp;
    const Camera& camera = listing_.camera;
    const ExpectedSize size{{camera.width, camera.height}, listing_.calibration_source};
    image.color = listing_.load_color ? listing_.load_color(index, files, size)
                                      : read_color_image(files.color, size);
    if (files.depth.empty()) return image;
    image.depth = metric_depth(raw_depth(index, size));
    return image;
  }

  cv::Mat raw_depth(std::size_t index, const ExpectedSize& color_size) const {
    ExpectedSize size = color_size;
    if (!listing_.raw_depth_size.empty()) {
      size = {listing_.raw_depth_size, "the calibration of the depth camera"};
    }
    const ListedFrame& files = listing_.frames[index];
    return listing_.load_depth ? listing_.load_depth(index, files, size)
                               : read_depth_image(files.depth, size);
  }

  cv::Mat metric_depth(cv::Mat depth) const {
    const Camera& camera = listing_.camera;
    if (depth.type() == CV_32FC1 && listing_.register_depth) {  // which works on raw units
      depth.convertTo(depth, CV_16U, camera.depth_factor);
    }
    if (listing_.register_depth) depth = listing_.register_depth(depth);
    if (depth.type() == CV_16UC1) depth.convertTo(depth, CV_32F, 1.0 / camera.depth_factor);
    return depth;
  }

  SequenceListing listing_;
  RecordingFacts facts_;
  std::vector<SkippedFrame> skipped_;
};

void note_on_stamps(SequenceListing& listing) {
  std::vector<double> stamps;
  for (const ListedFrame& frame : listing.frames) stamps.push_back(frame.stamp);
  const std::string hint = stamp_hint(stamps);
  if (!hint.empty()) listing.notes.push_back("the images' " + hint);
  const Trajectory& truth = listing.ground_truth;
  if (truth.empty()) return;
  if (truth.front().stamp <= stamps.back() && truth.back().stamp >= stamps.front()) return;
  listing.notes.push_back(
      fmt::format("the true trajectory ({:.13g} to {:.13g} s) and the images ({:.13g} to {:.13g} "
                  "s) have no time "
                  "in common",
                  truth.front().stamp, truth.back().stamp, stamps.front(), stamps.back()));
}

// A principal point in a corner is that of images of another size, or of a part of them.
void note_on_camera(SequenceListing& listing) {
  const Camera& c = listing.camera;
  const double x = c.cx / c.width;
  const double y = c.cy / c.height;
  if (std::abs(x - 0.5) <= kOffCentre && std::abs(y - 0.5) <= kOffCentre) return;
  listing.notes.push_back(fmt::format(
      "the principal point of {}, ({:g}, {:g}), is far from the middle of images of {}x{}: is the "
      "calibration that of another image size?",
      listing.calibration_source, c.cx, c.cy, c.width, c.height));
}

// Rows cannot be read longer than until the next image begins.
void require_possible_readout(const SequenceListing& listing) {
  constexpr double kJitter = 1.2;
  const double readout = listing.camera.readout_time;
  if (readout == 0.0 || listing.frames.size() < 2) return;
  std::vector<double> steps;
  for (std::size_t i = 1; i < listing.frames.size(); ++i) {
    steps.push_back(listing.frames[i].stamp - listing.frames[i - 1].stamp);
  }
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  if (readout <= kJitter * *middle) return;
  throw InputError(fmt::format(
      "{}: readout_time is {:g} s, but from image to image of {} it is {:.4g} s, expected less "
      "than that",
      listing.calibration_source, readout, listing.name, *middle));
}

}  // namespace

std::vector<std::size_t> probe_order(std::size_t count) {
  constexpr std::size_t kSpread = 100;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < std::min(count, kProbeAttempts); ++i) order.push_back(i);
  const std::size_t rest = count - order.size();
  const std::size_t wanted = std::min(rest, kSpread);
  for (std::size_t i = 0; i < wanted; ++i) {
    order.push_back(kProbeAttempts + (2 * i + 1) * rest / (2 * wanted));
  }
  return order;
}

std::unique_ptr<RgbdSequence> make_sequence(SequenceListing listing) {
  require(!listing.frames.empty(), "a sequence must have frames");
  listing.camera.prepare(listing.calibration_source);
  require_possible_readout(listing);
  note_on_stamps(listing);
  note_on_camera(listing);
  auto sequence = std::make_unique<ListedSequence>(std::move(listing));
  sequence->probe();
  return sequence;
}

}  // namespace dxslam
