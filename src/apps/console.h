// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "io/primitives/utf8.h"

namespace dxslam::apps {

// All that the program says goes through here. Nothing in here throws for a console that fails or
// waits for one once a stop was requested. Any thread.

/// To stdout, as it is.
void print_text(std::string_view text);
/// "dxslam: TEXT" as a line on stderr, printable. Given up if stderr takes nothing for a second.
void warn_text(std::string_view text);
/// To stderr, as it is, unless stderr takes nothing just now.
void draw_text(std::string_view text);
/// The errno of the first write to stdout that failed; 0 if none did.
int stdout_error();

/// What is formatted in place of an argument: text is made printable.
template <class T>
decltype(auto) shown(const T& value) {
  if constexpr (std::is_convertible_v<const T&, std::string_view>) {
    return printable(value);
  } else {
    return (value);
  }
}
template <class T>
using Shown = std::decay_t<decltype(shown(std::declval<const T&>()))>;

/// "1 frame", "2 frames"; `what` is one of them.
std::string counted(std::size_t count, std::string_view what);

/// To stdout.
template <class... Args>
void print(fmt::format_string<const Shown<Args>&...> format, const Args&... args) {
  print_text(fmt::format(format, static_cast<const Shown<Args>&>(shown(args))...));
}
/// One sentence to stderr: "dxslam: SENTENCE".
template <class... Args>
void warn(fmt::format_string<const Args&...> format, const Args&... args) {
  warn_text(fmt::format(format, args...));
}

}  // namespace dxslam::apps
