// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "apps/failure.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <opencv2/core.hpp>
#include <system_error>

#include "apps/commands.h"
#include "core/error.h"

namespace dxslam::apps {
namespace {

Failure no_memory() {
  return {"there is not enough memory for this, expected more of it, or smaller or fewer inputs",
          kBadInput};
}

Failure refused(const char* what) {
  return {fmt::format("the operating system gives no more threads, open files or memory: {}", what),
          kBadInput};
}

// Libraries of others throw what is no system_error where they get no thread.
bool names_shortage(const std::string& what) {
  return what.find(std::strerror(EAGAIN)) != std::string::npos ||
         what.find(std::strerror(ENOMEM)) != std::string::npos;
}

}  // namespace

Failure failure_of(const std::exception& error) {
  if (const auto* input = dynamic_cast<const InputError*>(&error)) {
    return {input->what(), kBadInput};
  }
  if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&error)) {
    return {fmt::format("{}: {}", file->path1().string(), file->code().message()), kBadInput};
  }
  if (dynamic_cast<const std::system_error*>(&error) != nullptr) {  // no thread, no descriptor
    return refused(error.what());
  }
  const auto* opencv = dynamic_cast<const cv::Exception*>(&error);
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr ||
      (opencv != nullptr && opencv->code == cv::Error::StsNoMem)) {
    return no_memory();
  }
  if (opencv == nullptr && names_shortage(error.what())) return refused(error.what());
  return {fmt::format("internal error: {}", error.what()), kInternalError};
}

Failure current_failure() {
  try {
    throw;
  } catch (const std::exception& e) {
    return failure_of(e);
  }
}

}  // namespace dxslam::apps
