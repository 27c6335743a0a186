// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <stdexcept>
#include <string>

namespace dxslam {

/// Unusable input from outside (a file, an image, a configuration). The text is one sentence that
/// says what was found, where, and what was expected. Programs show it to the user as it is.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A broken contract between two parts of the program: always a bug of the caller.
class ContractError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Throws ContractError with `what` unless `condition` holds.
inline void require(bool condition, const char* what) {
  if (!condition) throw ContractError(what);
}
inline void require(bool condition, const std::string& what) {
  if (!condition) throw ContractError(what);
}

}  // namespace dxslam
