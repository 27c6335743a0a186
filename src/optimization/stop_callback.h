// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <ceres/iteration_callback.h>

#include "optimization/may_go_on.h"

namespace dxslam {

/// Lets Ceres ask before every step whether it may go on. `may_go_on` must outlive it.
class StopCallback final : public ceres::IterationCallback {
 public:
  explicit StopCallback(const MayGoOn& may_go_on) : may_go_on_(may_go_on) {}

  /// Asks once, which may wait; after a "no" it does not ask again.
  bool stops() {
    stopped_ = stopped_ || (may_go_on_ && !may_go_on_());
    return stopped_;
  }
  bool stopped() const { return stopped_; }  ///< what the answers so far were; does not wait

  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    return stops() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }

 private:
  const MayGoOn& may_go_on_;
  bool stopped_ = false;
};

}  // namespace dxslam
