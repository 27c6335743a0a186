// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <nlohmann/json.hpp>

#include "evaluation/statistics.h"

namespace dxslam::apps {

inline nlohmann::ordered_json statistics_json(const ErrorStatistics& s) {
  return {{"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median}, {"std", s.std},
          {"min", s.min},   {"max", s.max},   {"count", s.count}};
}

}  // namespace dxslam::apps
