// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "core/frame.h"
#include "core/sequence.h"

namespace dxslam {

/// Which of the images of a source are wanted.
struct ImageSelection {
  std::size_t stride = 1;  ///< every n-th, from the first on
  std::size_t most = 0;    ///< at most so many of these; 0: all
};

/// Images one after another, from a recording or a live camera: what SLAM feeds on.
///
/// Threads: one at a time may use a source, but for stop(), which any may call.
/// Time: the stamps of a source rise, in seconds of one clock: that of the recording, or, of a live
/// source, of the system (since 1970).
/// Ownership: the images given are the caller's alone; a source never writes to them again.
class ImageSource : public ImageOrigin {
 public:
  /// Waits for the next image and returns it; nothing at the end: of the recording, after stop(),
  /// or where `most` of the selection were given. From then on there is nothing.
  /// A recording waits for its disk alone. A live source waits for its camera, and keeps only the
  /// newest images meanwhile: who asks too seldom loses old ones, and they are counted.
  /// Images that are broken are passed over and added to skipped(). Throws InputError, one
  /// sentence, where no image can be expected any more: the camera was unplugged, or has been
  /// silent for too long. What else is thrown (memory) concerns the image at index() alone.
  virtual std::optional<RgbdImage> next() = 0;
  /// Ends the source: next(), also one that waits already, returns nothing as soon as it can. Of a
  /// recording that is after the image that is being read. Any thread; never waits.
  virtual void stop() = 0;

  /// Whether images come at a pace of their own, and are lost if nobody takes them.
  virtual bool is_live() const = 0;
  /// How many images next() will have come to at the end, broken ones included; nothing where that
  /// is not known, as for a live source.
  virtual std::optional<std::size_t> planned() const = 0;
  /// How many it has come to so far, broken ones included.
  virtual std::size_t passed() const = 0;
  /// RgbdImage::index of the one that it came to last. 0 before the first.
  virtual std::size_t index() const = 0;
  /// Images of a live source that came too fast for the caller.
  virtual std::size_t dropped() const = 0;
};

/// The selected images of a recording, in order.
std::unique_ptr<ImageSource> make_image_source(std::unique_ptr<RgbdSequence> sequence,
                                               const ImageSelection& selection = {});

}  // namespace dxslam
