// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "relocalization/consensus.h"

#include "core/options.h"
#include "core/reach.h"

namespace dxslam {

RelocalizationConsensus::RelocalizationConsensus(const ConsensusOptions& options)
    : options_(options) {
  validate_options("consensus", options);
}

std::optional<RelocalizationReport> RelocalizationConsensus::add(
    double stamp, const RelocalizationReport& report) {
  if (report.accepted) {
    reset();
    return report;
  }
  const bool weak = report.has_pose && report.matched >= options_.min_matched &&
                    report.inliers >= options_.min_inliers &&
                    report.coverage >= options_.min_coverage;
  if (!weak) {
    reset();
    return std::nullopt;
  }
  agreeing_ = agrees(stamp, report) ? agreeing_ + 1 : 1;
  last_ = report;
  last_stamp_ = stamp;
  if (agreeing_ < options_.frames) return std::nullopt;
  RelocalizationReport accepted = report;
  accepted.accepted = true;
  reset();
  return accepted;
}

void RelocalizationConsensus::reset() { agreeing_ = 0; }

bool RelocalizationConsensus::agrees(double stamp, const RelocalizationReport& report) const {
  const double passed = stamp - last_stamp_;
  if (agreeing_ == 0 || !(passed > 0.0) || passed > options_.max_gap ||
      report.component != last_.component) {
    return false;
  }
  return is_within_reach(options_, last_.world_from_camera.inverse() * report.world_from_camera,
                         passed);
}

}  // namespace dxslam
