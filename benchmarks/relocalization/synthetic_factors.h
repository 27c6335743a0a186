// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "features/extractor.h"
#include "relocalization/relocalization_options.h"

namespace dxslam::benchmark {

struct SyntheticTrial {
  std::function<std::unique_ptr<FeatureExtractor>()> make_extractor;
  RelocalizationOptions options;
  std::string csv;  ///< as of append_csv(); empty: none
  std::string scene = "room";
  std::string only;       ///< factors whose name has this
  double fps = 5.0;       ///< of both passes
  int every_query = 10;   ///< every n-th frame of the second pass is asked as an isolated image
  double longest = 60.0;  ///< seconds of the second pass that are asked one after another
};

/// A map of a synthetic scene from one pass, queries from a second pass that differs in one factor
/// (docs/relocalization.md): one row a factor with the re-localization score of OpenLORIS
/// (exp(-t / 60 s) for a first pose after t that is right within 0.3 m, else 0) and the share of
/// isolated images located right. Prints a table in Markdown to stdout.
void measure_synthetic_factors(const SyntheticTrial& trial);

}  // namespace dxslam::benchmark
