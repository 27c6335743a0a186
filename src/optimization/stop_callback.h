// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <ceres/iteration_callback.h>

#include "optimization/may_go_on.h"

namespace dxslam {

/// Lets Ceres ask before every step whether it may go on; where it may not, the solver ends with
/// ceres::USER_FAILURE. `may_go_on` must outlive this.
class StopCallback final : public ceres::IterationCallback {
 public:
  explicit StopCallback(const MayGoOn& may_go_on) : may_go_on_(may_go_on) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    return must_stop(may_go_on_) ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }

 private:
  const MayGoOn& may_go_on_;
};

}  // namespace dxslam
