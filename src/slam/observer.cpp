// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/observer.h"

namespace dxslam {

const char* describe(SkipReason reason) {
  switch (reason) {
    case SkipReason::kUnreadable:
      return "it could not be read";
    case SkipReason::kNotExtracted:
      return "its features could not be extracted";
    case SkipReason::kDropped:
      return "tracking was too far behind";
  }
  return "";
}

}  // namespace dxslam
