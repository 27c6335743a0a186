// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "features/extractor.h"
#include "features/extractor_options.h"
#include "synthetic/low_light.h"

namespace dxslam::apps {

/// What the commands about features have in common.
struct FeatureArguments {
  std::string features;  ///< name or manifest; the default extractor where empty
  ExtractorOptions options;
};

/// Adds --features, --max-keypoints, --threads, --precision and --deterministic.
void add_feature_options(CLI::App& command, FeatureArguments& arguments);

/// Adds --low-light[=GAIN]; `gain` stays 0 without it.
void add_low_light_option(CLI::App& command, double& gain);

std::unique_ptr<FeatureExtractor> make_extractor(const FeatureArguments& arguments);

/// Reads an image file, and darkens it where `gain` is above 0.
cv::Mat read_image(const std::string& path, double gain);

// The commands, each in its own file; add_features_command() adds all three.
void add_extract_command(CLI::App& app);
void add_match_command(CLI::App& app);
void add_bench_command(CLI::App& app);

}  // namespace dxslam::apps
