// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/sequence.h"
#include "synthetic/camera_path.h"
#include "synthetic/layout.h"
#include "synthetic/lens_view.h"
#include "synthetic/low_light.h"
#include "synthetic/people.h"
#include "synthetic/renderer.h"
#include "synthetic/synthetic_options.h"
#include "synthetic/world.h"

namespace dxslam {

/// A recording of a synthetic world, drawn when it is read; nothing touches the disk. Equal options
/// give equal frames, bit by bit, in any order of reading and with any number of threads.
class SyntheticSequence : public RgbdSequence {
 public:
  /// Builds the world, which takes from half a second (room) to some seconds (corridor). Throws
  /// InputError for options out of range and unknown scenes.
  explicit SyntheticSequence(const SyntheticOptions& options);

  const std::string& name() const override { return name_; }
  const Camera& camera() const override { return camera_; }
  /// Without the depths, which nobody has drawn yet.
  const RecordingFacts& facts() const override { return facts_; }
  std::size_t size() const override { return ground_truth_.size(); }
  double stamp(std::size_t index) const override;
  std::optional<RgbdImage> read(std::size_t index) override;
  const std::vector<SkippedFrame>& skipped() const override { return skipped_; }
  /// In the frame of the world: z up, floor at 0.
  const Trajectory& ground_truth() const override { return ground_truth_; }

  /// As read(); any number of threads may call it at once. `threads` share the rows of the image.
  RgbdImage draw(std::size_t index, int threads) const;
  /// Frame `index` as an ideal camera sees it, people included: sharp, free of noise.
  Rendering draw_ideal(std::size_t index, int threads) const;

  const SyntheticOptions& options() const { return options_; }
  const World& world() const { return world_; }
  const Layout& layout() const { return layout_; }
  /// Metres that the camera travels within the recording, without trembling.
  double path_length() const;

 private:
  /// Through the lens.
  Rendering seen(const std::vector<Surface>& extra, const SE3& world_from_camera,
                 const RenderOptions& options) const;
  cv::Mat exposed_radiance(const Rendering& sharp, double time, int threads) const;

  SyntheticOptions options_;
  std::string name_;
  Camera camera_;
  std::optional<LensView> lens_view_;
  RecordingFacts facts_{"the synthetic camera", true, 0.0, 0.0, {}, {}};
  Layout layout_;
  World world_;
  std::optional<CameraPath> path_;
  std::optional<People> people_;
  std::optional<LowLight> low_light_;
  Trajectory ground_truth_;
  std::vector<SkippedFrame> skipped_;
};

std::unique_ptr<SyntheticSequence> make_synthetic_sequence(const SyntheticOptions& options);

}  // namespace dxslam
