// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/output_steps.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "apps/commands.h"
#include "apps/console.h"
#include "apps/failure.h"

namespace dxslam::apps {

bool OutputSteps::run(const std::function<void()>& write) {
  try {
    write();
    return true;
  } catch (const std::exception&) {
    Failure failure = current_failure();
    bug_ = bug_ || failure.code == kInternalError;
    keep(std::move(failure.sentence));
  }
  return false;
}

void OutputSteps::keep(std::string failure) {
  if (std::find(failures_.begin(), failures_.end(), failure) != failures_.end()) return;
  failures_.push_back(std::move(failure));
}

void OutputSteps::tell_place(const std::string& folder) const {
  print("results{} in {}\n", failures_.empty() ? "" : ", as far as they could be written,", folder);
}

int OutputSteps::report(int code) const {
  for (const std::string& failure : failures_) warn("{}", failure);
  if (bug_) return kInternalError;
  return failures_.empty() ? code : kBadInput;
}

int OutputSteps::end_results(ResultFolder* folder, int code) const {
  code = report(code);
  if (folder == nullptr) return code;
  if (code == kSuccess) folder->finish();
  if (const std::string kept = folder->kept(); !kept.empty()) {
    warn("the results of before are kept in {}", kept);
  }
  return code;
}

void OutputSteps::end_command() const {
  if (const int code = report(kSuccess); code != kSuccess) throw CLI::RuntimeError(code);
}

}  // namespace dxslam::apps
