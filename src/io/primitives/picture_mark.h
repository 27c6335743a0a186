// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <string_view>

#include "io/primitives/output_file.h"

namespace dxslam {

/// The bytes of a PNG or JPEG file, with a comment in it that says what wrote it (a few words of
/// ASCII), by which it is told from a user's photos. Others are returned as they are.
std::string mark_picture(std::string picture, std::string_view software);

/// Pictures that mark_picture() has marked so, under names that encode_image() takes.
FileKind marked_picture_kind(std::string name, const std::string& software);

}  // namespace dxslam
