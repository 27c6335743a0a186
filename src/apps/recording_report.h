// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/image_source.h"
#include "core/sequence.h"
#include "core/trajectory.h"
#include "evaluation/statistics.h"
#include "evaluation/time_offset.h"

namespace dxslam::apps {

/// Frame `index` is skipped for what was thrown while it was read or worked on.
SkippedFrame skipped_for(std::size_t index, const std::exception& error);
/// The next image of a source; nothing at the end and after a stop. What cannot be read costs this
/// image alone, and is added to `failed`; that no image can come any more is thrown. `tell`, where
/// given, gets all that could not be read.
std::optional<RgbdImage> next_image(ImageSource& source, std::vector<SkippedFrame>& failed,
                                    const std::function<void(const SkippedFrame&)>& tell = {});
/// Work on the images of a recording, one after another. What is thrown concerns one image alone,
/// unless the first ones fail alike: then the others would, too (a network that this memory or this
/// size of images is too small for).
class ImageAttempts {
 public:
  /// Calls `work`, which reads an image and works on it. Returns why the image was skipped. Throws
  /// InputError where the first kAlike images were skipped for one reason.
  std::optional<SkippedFrame> attempt(std::size_t index, const std::function<void()>& work);
  static constexpr std::size_t kAlike = 3;

 private:
  bool has_worked_ = false;
  std::size_t failures_ = 0;
  std::string reason_;  // of the first
};
/// Frames that could not be read, and `failed` ones, in order.
std::vector<SkippedFrame> all_skipped(const ImageOrigin& recording,
                                      const std::vector<SkippedFrame>& failed);
/// Says on stderr how many there are and why the first was skipped; nothing where there is none.
void print_skipped(const std::vector<SkippedFrame>& skipped);

/// Two lines on stderr: the calibration used and its source, and what the depth images hold.
void print_recording(const ImageOrigin& recording);
/// The same as fields: calibration, camera, depth_factor, median_depth_m, depth_share.
nlohmann::ordered_json recording_json(const ImageOrigin& recording);
nlohmann::ordered_json camera_json(const Camera& camera);

/// An estimate beside the true trajectory.
struct TruthReport {
  ErrorStatistics position;         ///< metres, aligned by SE(3): the ATE
  double scale = 1.0;               ///< of an alignment by Sim(3): truth = scale * estimate
  double rmse_with_scale = 0.0;     ///< metres, of that alignment
  double extent = 0.0;              ///< metres, of the true path
  std::optional<TimeOffset> clock;  ///< likely_offset() of the estimate's stamps
  /// By more than 10 %, and the truth shows it: the path is long enough for that.
  bool scale_is_wrong() const;
};
/// Nothing where there is no truth; nor, with the reason on stderr, where there is too little of
/// both to be aligned.
std::optional<TruthReport> compare_with_truth(const ImageOrigin& recording,
                                              const Trajectory& estimate);
/// The unit that explains a path `scale` times as long as in metres: millimetres or centimetres.
/// Null where none does. No depth factor explains it: one so wrong shows in the depth.
const char* likely_unit(double scale);
/// A line on stdout, and a sentence on stderr if the scale is wrong, or the clock.
void print_truth(const TruthReport& report, const Camera& camera);
nlohmann::ordered_json truth_json(const std::optional<TruthReport>& report);

}  // namespace dxslam::apps
