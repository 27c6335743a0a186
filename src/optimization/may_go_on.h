// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <functional>

namespace dxslam {

/// Asked before every step of a solver, in the solver's thread. It may wait; on false the solver
/// ends without a result. Empty: goes on.
using MayGoOn = std::function<bool()>;

/// Asks, which may wait.
inline bool must_stop(const MayGoOn& may_go_on) { return may_go_on && !may_go_on(); }

}  // namespace dxslam
