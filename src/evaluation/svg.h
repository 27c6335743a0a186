// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>

#include "io/primitives/output_file.h"

namespace dxslam {

// Parts of SVG pictures; coordinates in pixels, y downwards.

/// Pictures that begin as those drawn here.
FileKind svg_kind();

/// Begins a white picture with the text classes title (20 px, bold), label and sub (14 px), tick
/// (12 px) and halo (outlined in the colour of a plot). To be ended with "</svg>\n".
std::string svg_begin(double width, double height);

/// Text whose baseline begins at (x, y); `attributes` e.g. class="label". Not escaped.
std::string svg_text(double x, double y, const std::string& text, const std::string& attributes);

/// `text` without what XML takes for markup; control characters become blanks, bytes that are not
/// UTF-8 become U+FFFD.
std::string svg_escaped(const std::string& text);

/// A round dot with a white rim, 5.5 px in radius.
std::string svg_dot(double x, double y, const std::string& color);

/// The largest of 1, 2 and 5 times a power of ten that is not above `length`, which is positive.
double round_length(double length);

}  // namespace dxslam
