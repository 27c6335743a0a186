// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/progress.h"

#include <unistd.h>

#include <algorithm>

#include "apps/console.h"

namespace dxslam::apps {
namespace {

constexpr double kTerminalInterval = 0.1;  // seconds between two drawings
constexpr double kPlainInterval = 5.0;
constexpr std::size_t kBarWidth = 24;

}  // namespace

Progress::Progress(std::string title, std::size_t total, Unit unit)
    : title_(std::move(title)), total_(total), unit_(unit), terminal_(isatty(STDERR_FILENO) == 1) {}

void Progress::update(std::size_t done, const std::string& state) {
  const Clock::time_point now = Clock::now();
  const double since = std::chrono::duration<double>(now - last_).count();
  if ((done < total_ || total_ == 0) && since < (terminal_ ? kTerminalInterval : kPlainInterval))
    return;
  last_ = now;
  drawn_ = true;
  draw(done, state, std::chrono::duration<double>(now - start_).count());
}

void Progress::draw(std::size_t done, const std::string& state, double elapsed) const {
  const double rate = elapsed > 0.0 ? static_cast<double>(done) / elapsed : 0.0;
  const double left =
      rate > 0.0 ? static_cast<double>(total_ - std::min(done, total_)) / rate : 0.0;
  std::string text =
      fmt::format("{}/{}  {:.1f}/s  {}  {:.0f} s left", done, total_, rate, state, left);
  if (total_ == 0) text = fmt::format("{}  {:.1f}/s  {}", done, rate, state);
  if (unit_ == Unit::kShare) {
    const double share = static_cast<double>(done) / static_cast<double>(total_);
    text = fmt::format("{:.0f} %  {}  {:.0f} s left", 100.0 * share, state, left);
  }
  if (!terminal_) {
    draw_text(fmt::format("{}: {}\n", title_, text));
    return;
  }
  const std::size_t filled = total_ == 0 ? kBarWidth : kBarWidth * std::min(done, total_) / total_;
  draw_text(fmt::format("\r{} [{}{}] {}\033[K", title_, std::string(filled, '#'),
                        std::string(kBarWidth - filled, '.'), text));
}

void Progress::finish() {
  if (terminal_ && drawn_) draw_text("\n");
}

}  // namespace dxslam::apps
