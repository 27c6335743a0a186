// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/process.h"

#include <atomic>
#include <csignal>

namespace dxslam::apps {
namespace {

std::atomic<bool> requested{false};

void request_stop(int) { requested = true; }

}  // namespace

void catch_signals() {
  struct sigaction action{};
  action.sa_handler = request_stop;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool stop_requested() { return requested; }

}  // namespace dxslam::apps
