// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "ros2/signals.h"

#include <semaphore.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <utility>

#include "ros2/error.h"

namespace dxslam::ros2 {
namespace {

constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};

// A handler can reach nothing but globals, and of all ways to wake a thread only sem_post is safe.
sem_t signalled;
std::atomic<bool> in_use = false;
std::atomic<bool> ending = false;
std::array<struct sigaction, kSignals.size()> before;

void handle(int /*signal*/) {
  const int kept = errno;
  sem_post(&signalled);
  errno = kept;
}

}  // namespace

StopOnSignal::StopOnSignal(std::function<void()> stop) {
  if (in_use.exchange(true)) throw Error("signals are already taken care of");
  ending = false;
  sem_init(&signalled, 0, 0);
  thread_ = std::thread([stop = std::move(stop)] {
    while (true) {
      while (sem_wait(&signalled) != 0) {
      }
      if (ending) return;
      stop();
    }
  });
  struct sigaction action{};
  action.sa_handler = handle;
  action.sa_flags = SA_RESTART;
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    sigaction(kSignals[i], nullptr, &before[i]);
    if (before[i].sa_handler != SIG_IGN) sigaction(kSignals[i], &action, nullptr);
  }
}

StopOnSignal::~StopOnSignal() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before[i], nullptr);
  ending = true;
  sem_post(&signalled);
  thread_.join();
  sem_destroy(&signalled);
  in_use = false;
}

}  // namespace dxslam::ros2
