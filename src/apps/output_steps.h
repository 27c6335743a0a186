// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "io/primitives/result_folder.h"

namespace dxslam::apps {

/// The outputs at the end of a command, each written on its own: one that fails costs no other.
class OutputSteps {
 public:
  /// Calls `write`, and keeps the sentence of what it throws. Returns whether it threw nothing.
  bool run(const std::function<void()>& write);
  /// One sentence for each failure so far; none twice.
  const std::vector<std::string>& failures() const { return failures_; }
  /// Says on stdout where the results are.
  void tell_place(const std::string& folder) const;
  /// Says all failures on stderr, one per line. Returns the command's exit code: `code` if there is
  /// none.
  int report(int code) const;
  /// The same as the end of a command that went well otherwise: throws CLI::RuntimeError with the
  /// exit code unless there is no failure.
  void end_command() const;
  /// The same as report(), and ends the results in `folder`, null where there are none: after
  /// exit code 0 they replace the last ones; else it is said where those are kept.
  int end_results(ResultFolder* folder, int code) const;

 private:
  void keep(std::string failure);

  std::vector<std::string> failures_;
  bool bug_ = false;
};

}  // namespace dxslam::apps
