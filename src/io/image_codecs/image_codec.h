// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace dxslam {

/// One kind of image file. Its functions take the whole file, keep no state, may be called from
/// any thread and print nothing. They throw InputError with what is wrong, without the file's name.
struct ImageCodec {
  /// From the first 16 bytes or fewer.
  bool (*recognises)(std::string_view start);
  /// Width and height as the header says, unchecked but not negative. Finds out cheaply whether
  /// the file is whole and refuses one that is cut.
  cv::Size_<std::uint32_t> (*inspect)(std::string_view bytes);
  /// CV_8UC1, CV_8UC3 (BGR), CV_16UC1, CV_16UC3 (BGR) or CV_32FC1, as the file has it; alpha is
  /// dropped, and no EXIF orientation applied. Only for what inspect() accepted and whose size is
  /// within the limits.
  cv::Mat (*decode)(std::string_view bytes);
};

extern const ImageCodec kPngCodec;
extern const ImageCodec kJpegCodec;
extern const ImageCodec kBmpCodec;
extern const ImageCodec kPnmCodec;
extern const ImageCodec kTiffCodec;
extern const ImageCodec kExrCodec;

/// CV_8UC1, CV_8UC3 (BGR) or CV_16UC1 as PNG. `level`: zlib's, 1 (fast) to 9 (small).
std::string encode_png(const cv::Mat& image, int level);
/// CV_8UC1 or CV_8UC3 (BGR) as JPEG; `quality` 1 to 100.
std::string encode_jpeg(const cv::Mat& image, int quality);

}  // namespace dxslam
