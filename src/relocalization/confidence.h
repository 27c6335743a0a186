// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

namespace dxslam {

struct RelocalizationReport;

/// Probability that a found pose is right, from what it rests on: the points matched without
/// knowing the pose and the points found around their projections. A logistic model of the
/// logarithms of both; docs/relocalization.md says what it was fitted to.
double relocalization_confidence(const RelocalizationReport& report);

}  // namespace dxslam
