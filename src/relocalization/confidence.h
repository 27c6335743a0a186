// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

namespace dxslam {

struct RelocalizationReport;

/// Probability that a found pose is right, from what it rests on: points matched without knowing
/// the pose, the share of the points in view that were found, and their spread. A logistic model;
/// docs/relocalization.md says what it was fitted to.
double relocalization_confidence(const RelocalizationReport& report);

}  // namespace dxslam
