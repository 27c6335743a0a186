// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "tracking/tracking_types.h"

namespace dxslam {

const char* describe(LossReason reason) {
  switch (reason) {
    case LossReason::kFewKeypoints:
      return "too few keypoints";
    case LossReason::kFewDepths:
      return "too few keypoints with depth";
    case LossReason::kFewMatches:
      return "too few known points were found";
    case LossReason::kNoAgreement:
      return "the points found agree on no pose";
    case LossReason::kDisbelieved:
      return "the pose found is not believed";
    case LossReason::kPlaceUnknown:
      return "the place was not found in the map";
  }
  return "";
}

}  // namespace dxslam
