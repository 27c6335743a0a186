// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>

namespace dxslam {

/// A JSON document as a file holds it: two blanks of indent and a line end. Names of files need not
/// be UTF-8; bytes that are not become U+FFFD, for the document must be. `Json` is any of
/// nlohmann's types.
template <class Json>
std::string to_json_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace dxslam
