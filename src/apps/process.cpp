// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/process.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "apps/commands.h"
#include "apps/console.h"
#include "core/parallel.h"
#include "io/primitives/atomic_file.h"

namespace dxslam::apps {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kGrace{1000};       // from the stop to the end of the process
constexpr std::chrono::milliseconds kAfterSaving{500};  // for the last words

struct State {
  std::stop_source stop;
  std::mutex mutex;
  std::condition_variable saved;
  int unsaved = 0;          // guarded by mutex
  Clock::time_point quiet;  // guarded by mutex; when unsaved last became 0
  std::atomic<bool> abandoned{false};
  std::atomic<bool> told{false};  // that it was stopped
};

// Never destroyed: the watching thread and abandoned ones live as long as the process.
State& state() {
  static State& the = *new State;
  return the;
}

void open_console() {
  for (int descriptor = 0; descriptor <= 2; ++descriptor) {
    if (::fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
    // The lowest free number is this one.
    static_cast<void>(::open("/dev/null", descriptor == 0 ? O_RDONLY : O_WRONLY));
  }
}

// Whoever started the program may have it ignore some: nohup, or a shell that runs it behind.
sigset_t stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action{};
    const bool known = ::sigaction(number, nullptr, &action) == 0;
    if (!known || action.sa_handler != SIG_IGN) sigaddset(&signals, number);
  }
  return signals;
}

void tell_stop() {
  if (!state().told.exchange(true)) warn("stopped by a signal");
}

// Ends the process once nothing is unsaved and the last words had their time.
void end_when_saved() {
  State& s = state();
  std::unique_lock lock(s.mutex);
  const Clock::time_point stopped = Clock::now();
  for (;;) {
    s.saved.wait(lock, [&] { return s.unsaved == 0; });
    const Clock::time_point end = std::max(stopped + kGrace, s.quiet + kAfterSaving);
    if (Clock::now() >= end) break;
    s.saved.wait_until(lock, end);
  }
  // Both locks are kept: nothing can be begun any more.
  const std::unique_lock files(files_being_written());
  tell_stop();
  ::_exit(kInterrupted);
}

void watch(const sigset_t& signals) {
  int signal = 0;
  sigwait(&signals, &signal);
  state().stop.request_stop();
  stop_waiting_for_readers();
  if (std::thread ending = thread_if_possible(end_when_saved); ending.joinable()) {
    ending.detach();
  } else {
    end_when_saved();
  }
  for (bool said = false;; said = true) {
    sigwait(&signals, &signal);
    if (!said) warn("stopping; Ctrl-\\ (SIGQUIT) ends it at once and saves nothing");
  }
}

}  // namespace

void prepare_process() {
  open_console();
  ::signal(SIGPIPE, SIG_IGN);
  ::signal(SIGXFSZ, SIG_IGN);
  // Threads inherit the mask, so only the one that waits for the signals gets them.
  const sigset_t signals = stop_signals();
  ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  state();
  if (std::thread watching = thread_if_possible([signals] { watch(signals); });
      watching.joinable()) {
    watching.detach();
  } else {
    ::pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);  // rather end at once than be deaf
  }
}

bool stop_requested() { return state().stop.stop_requested(); }

std::stop_token stop_token() { return state().stop.get_token(); }

void sleep_until(std::chrono::steady_clock::time_point when) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  never.wait_until(lock, stop_token(), when, [] { return false; });
}

Unsaved::Unsaved() {
  const std::lock_guard lock(state().mutex);
  ++state().unsaved;
}

Unsaved::~Unsaved() {
  const std::lock_guard lock(state().mutex);
  --state().unsaved;
  state().quiet = Clock::now();
  state().saved.notify_all();
}

void abandon_thread() { state().abandoned = true; }

int end_process(int code) {
  if (stop_requested() && code != kSuccess) tell_stop();
  if (state().abandoned) ::_exit(code);
  return code;
}

}  // namespace dxslam::apps
