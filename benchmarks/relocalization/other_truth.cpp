// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "other_truth.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "core/error.h"
#include "evaluation/association.h"
#include "io/recordings/sequence_reader.h"

namespace dxslam::benchmark {
namespace {

constexpr double kSameStamp = 1e-3;  // seconds

class OtherTruth : public RgbdSequence {
 public:
  OtherTruth(std::unique_ptr<RgbdSequence> sequence, Trajectory truth)
      : sequence_(std::move(sequence)), truth_(std::move(truth)) {}
  const std::string& name() const override { return sequence_->name(); }
  const Camera& camera() const override { return sequence_->camera(); }
  const RecordingFacts& facts() const override { return sequence_->facts(); }
  std::size_t size() const override { return sequence_->size(); }
  double stamp(std::size_t index) const override { return sequence_->stamp(index); }
  std::optional<RgbdImage> read(std::size_t index) override { return sequence_->read(index); }
  const std::vector<SkippedFrame>& skipped() const override { return sequence_->skipped(); }
  const Trajectory& ground_truth() const override { return truth_; }

 private:
  std::unique_ptr<RgbdSequence> sequence_;
  Trajectory truth_;
};

}  // namespace

std::unique_ptr<RgbdSequence> with_truth(std::unique_ptr<RgbdSequence> sequence,
                                         const std::string& file) {
  const std::vector<PosePair> pairs =
      associate(load_ground_truth(file).poses, sequence->ground_truth(), kSameStamp);
  if (pairs.size() != sequence->size()) {
    throw InputError(
        fmt::format("{}: poses at the stamps of {} frames, expected them at all {} of {}", file,
                    pairs.size(), sequence->size(), sequence->name()));
  }
  Trajectory truth;
  for (const PosePair& pair : pairs) truth.push_back(pair.truth);
  return std::make_unique<OtherTruth>(std::move(sequence), std::move(truth));
}

}  // namespace dxslam::benchmark
