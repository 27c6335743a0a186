// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "core/sequence.h"

namespace dxslam::apps {

/// The colour images of recordings and of folders of photos, one after another. Depth is not used.
class ImageStream {
 public:
  /// Where an image comes from.
  struct Item {
    cv::Mat image;
    bool first = false;  ///< no neighbour of the image before: of another recording, or a photo
    bool photo = false;  ///< of a folder of single photos
  };

  /// Each source is a recording (any format that `dxslam run` reads) or a folder of photos (image
  /// files, ordered by the numbers in their names), whole or in part: SOURCE@FIRST:END or
  /// SOURCE@FIRST:END:STEP, counted from 0, END left out. `stride` n takes every n-th of these
  /// images. Throws InputError if a source cannot be used.
  ImageStream(const std::vector<std::string>& sources, std::size_t stride);

  std::size_t size() const { return images_.size(); }

  /// Calls `visit(index, item)` for the images from `start` on, until it returns false, or until a
  /// stop (process.h). Images that cannot be read are left out and counted. Throws InputError as
  /// the readers do.
  void visit(std::size_t start, const std::function<bool(std::size_t, const Item&)>& visit);
  std::size_t skipped() const { return skipped_; }
  /// Why the first of the skipped images was skipped.
  const std::string& first_skipped() const { return first_skipped_; }

 private:
  struct Image {
    std::size_t source = 0;
    std::size_t index = 0;  // in the recording
    std::string photo;      // path, of photos only
  };

  void add_source(const std::string& source, std::size_t stride);
  void skip(const std::string& reason);
  // Nothing where the image cannot be read.
  cv::Mat read_photo(const std::string& path);
  cv::Mat read_frame(RgbdSequence& sequence, std::size_t index);

  std::vector<std::string> folders_;  // by source
  std::vector<Image> images_;
  std::size_t skipped_ = 0;
  std::string first_skipped_;
};

/// The same scene from elsewhere: a photo seen from a slightly different place, in part much
/// darker; by `seed` alone.
cv::Mat changed_view(const cv::Mat& photo, unsigned seed);

}  // namespace dxslam::apps
