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

Failure current_failure() {
  try {
    throw;
  } catch (const InputError& e) {
    return {e.what(), kBadInput};
  } catch (const std::filesystem::filesystem_error& e) {
    return {fmt::format("{}: {}", e.path1().string(), e.code().message()), kBadInput};
  } catch (const std::system_error& e) {  // no thread, no descriptor
    return refused(e.what());
  } catch (const std::bad_alloc&) {
    return no_memory();
  } catch (const cv::Exception& e) {
    if (e.code == cv::Error::StsNoMem) return no_memory();
    return {fmt::format("internal error: {}", e.what()), kInternalError};
  } catch (const std::exception& e) {
    if (names_shortage(e.what())) return refused(e.what());
    return {fmt::format("internal error: {}", e.what()), kInternalError};
  }
}

}  // namespace dxslam::apps
