// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/output_steps.h"

#include <fmt/format.h>

#include <exception>
#include <filesystem>

#include "apps/commands.h"
#include "apps/console.h"
#include "core/error.h"

namespace dxslam::apps {

bool OutputSteps::run(const std::function<void()>& write) {
  try {
    write();
    return true;
  } catch (const InputError& e) {
    failures_.emplace_back(e.what());
  } catch (const std::filesystem::filesystem_error& e) {
    failures_.push_back(fmt::format("{}: {}", e.path1().string(), e.code().message()));
  } catch (const std::exception& e) {
    failures_.push_back(fmt::format("internal error: {}", e.what()));
    bug_ = true;
  }
  return false;
}

int OutputSteps::report(int code) const {
  for (const std::string& failure : failures_) warn("{}", failure);
  if (bug_) return kInternalError;
  return failures_.empty() ? code : kBadInput;
}

}  // namespace dxslam::apps
