// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "core/image_source.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "core/error.h"

namespace dxslam {
namespace {

class RecordedImages : public ImageSource {
 public:
  RecordedImages(std::unique_ptr<RgbdSequence> sequence, const ImageSelection& selection)
      : sequence_(std::move(sequence)), stride_(selection.stride) {
    require(stride_ > 0, "a stride is at least 1");
    const std::size_t all = (sequence_->size() + stride_ - 1) / stride_;
    planned_ = selection.most == 0 ? all : std::min(all, selection.most);
  }

  const std::string& name() const override { return sequence_->name(); }
  const Camera& camera() const override { return sequence_->camera(); }
  const RecordingFacts& facts() const override { return sequence_->facts(); }
  const std::vector<SkippedFrame>& skipped() const override { return sequence_->skipped(); }
  const Trajectory& ground_truth() const override { return sequence_->ground_truth(); }

  std::optional<RgbdImage> next() override {
    while (passed_ < planned_ && !stopped_) {
      const std::size_t broken = sequence_->skipped().size();
      ++passed_;  // first: it counts, too, if reading throws
      if (std::optional<RgbdImage> image = sequence_->read(index())) return image;
      if (sequence_->skipped().size() > broken) continue;
      --passed_;  // it was not read
      break;
    }
    stop();
    return std::nullopt;
  }
  void stop() override { stopped_ = true; }

  bool is_live() const override { return false; }
  std::optional<std::size_t> planned() const override { return planned_; }
  std::size_t passed() const override { return passed_; }
  std::size_t index() const override { return passed_ == 0 ? 0 : (passed_ - 1) * stride_; }
  std::size_t dropped() const override { return 0; }

 private:
  std::unique_ptr<RgbdSequence> sequence_;
  std::size_t stride_;
  std::size_t planned_ = 0;
  std::size_t passed_ = 0;
  std::atomic<bool> stopped_{false};
};

}  // namespace

std::unique_ptr<ImageSource> make_image_source(std::unique_ptr<RgbdSequence> sequence,
                                               const ImageSelection& selection) {
  require(sequence != nullptr, "a source needs a sequence");
  return std::make_unique<RecordedImages>(std::move(sequence), selection);
}

}  // namespace dxslam
