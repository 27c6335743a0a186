// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>

#include "core/error.h"
#include "io/image_codecs/byte_order.h"
#include "io/image_codecs/image_codec.h"
#include "io/primitives/limits.h"
#include "io/primitives/text_file.h"

// OpenEXR files with one channel of depth. The header is walked here first: the library would
// allocate what a damaged one asks for.

namespace dxslam {
namespace {

constexpr std::string_view kMagic("\x76\x2F\x31\x01", 4);
constexpr std::uint32_t kDeepOrManyParts = 0x800 | 0x1000;
constexpr std::size_t kMostChannels = 64;

bool recognises(std::string_view start) { return start.substr(0, 4) == kMagic; }

[[noreturn]] void cut() { throw InputError("truncated EXR, its header is not whole"); }

std::string_view name_at(std::string_view bytes, std::size_t& at) {
  if (at > bytes.size()) cut();
  const std::size_t end = bytes.substr(at, 256).find('\0');
  if (end == std::string_view::npos) cut();
  const std::string_view name = bytes.substr(at, end);
  at += end + 1;
  return name;
}

/// Calls visit(name, value) for each attribute.
template <class Visit>
void visit_attributes(std::string_view bytes, Visit visit) {
  std::size_t at = 8;
  while (true) {
    if (at >= bytes.size()) cut();
    const std::string_view name = name_at(bytes, at);
    if (name.empty()) return;
    name_at(bytes, at);  // the type
    if (bytes.size() - at < 4) cut();
    const std::size_t size = little_endian32(bytes, at);
    at += 4;
    if (size > bytes.size() - at) cut();
    visit(name, bytes.substr(at, size));
    at += size;
  }
}

// A channel: its name, and 16 bytes.
std::size_t count_channels(std::string_view value) {
  std::size_t count = 0;
  for (std::size_t at = 0; at < value.size() && value[at] != '\0'; ++count) {
    name_at(value, at);
    at += 16;
  }
  return count;
}

struct Outline {
  std::optional<cv::Size_<std::uint32_t>> size;
  std::size_t channels = 0;
  std::uint64_t tile = 0;  // pixels
};

// The decoder holds up to 256 rows, or a tile, of all channels.
void check_cost(const Outline& outline) {
  const std::uint64_t width = outline.size->width;
  const std::uint64_t channels = outline.channels;
  const std::uint64_t held = std::max(256 * width, outline.tile) * channels * sizeof(float);
  if (width > limits::kImageSide) return;  // is refused for its size
  if (held <= limits::kDecoderBytes && channels <= kMostChannels &&
      channels * width * outline.size->height <= 4 * limits::kImageArea) {
    return;
  }
  throw InputError(fmt::format("EXR of {}x{} pixels with {} channels, expected fewer channels",
                               width, outline.size->height, channels));
}

std::uint32_t side(std::string_view box, std::size_t lowest) {
  const auto low = static_cast<std::int32_t>(little_endian32(box, lowest));
  const auto high = static_cast<std::int32_t>(little_endian32(box, lowest + 8));
  const std::int64_t pixels = std::int64_t{high} - low + 1;
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(pixels, 0, 0xFFFFFFFFLL));
}

cv::Size_<std::uint32_t> inspect(std::string_view bytes) {
  if (bytes.size() < 8) cut();
  if ((little_endian32(bytes, 4) & kDeepOrManyParts) != 0) {
    throw InputError("EXR of several parts or deep pixels, expected one flat image");
  }
  Outline outline;
  visit_attributes(bytes, [&](std::string_view name, std::string_view value) {
    if (name == "channels") outline.channels = count_channels(value);
    if (name == "tiles" && value.size() >= 8) {
      outline.tile = std::uint64_t{little_endian32(value, 0)} * little_endian32(value, 4);
    }
    if (name == "dataWindow" && value.size() == 16) {
      outline.size.emplace(side(value, 0), side(value, 4));
    }
  });
  if (!outline.size) throw InputError("damaged EXR, no data window");
  check_cost(outline);
  return *outline.size;
}

class MemoryStream : public Imf::IStream {
 public:
  explicit MemoryStream(std::string_view bytes) : Imf::IStream("image"), bytes_(bytes) {}
  bool read(char target[], int count) override {
    const auto wanted = static_cast<std::size_t>(count);
    if (at_ > bytes_.size() || wanted > bytes_.size() - at_) {
      throw InputError("truncated EXR, bytes are missing at its end");
    }
    std::memcpy(target, bytes_.data() + at_, wanted);
    at_ += wanted;
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t position) override { at_ = position; }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

bool ends_with_z(const std::string& name) {
  return name == "Z" || (name.size() > 2 && name.compare(name.size() - 2, 2, ".Z") == 0);
}

/// The only channel, or the one called Z, perhaps with a layer's name before it.
std::string depth_channel(const Imf::ChannelList& channels) {
  std::string found;
  std::string all;
  int count = 0;
  for (auto channel = channels.begin(); channel != channels.end(); ++channel, ++count) {
    all += (count == 0 ? "" : " ") + std::string(channel.name());
    if (found.empty() && ends_with_z(channel.name())) found = channel.name();
  }
  if (found.empty() && count == 1) found = channels.begin().name();
  if (!found.empty()) return found;
  throw InputError(
      fmt::format("EXR with the channels {}, expected one only, or one called Z", in_quotes(all)));
}

cv::Mat read_depth(std::string_view bytes) {
  MemoryStream stream(bytes);
  Imf::InputFile file(stream, 0);
  const std::string name = depth_channel(file.header().channels());
  const Imf::Channel& channel = file.header().channels()[name];
  if (channel.xSampling != 1 || channel.ySampling != 1) {
    throw InputError("EXR with a subsampled channel, expected a value for each pixel");
  }
  const Imath::Box2i window = file.header().dataWindow();
  cv::Mat image(window.max.y - window.min.y + 1, window.max.x - window.min.x + 1, CV_32FC1,
                cv::Scalar(0));
  Imf::FrameBuffer buffer;
  buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, image.data, window, sizeof(float), image.step));
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);
  return image;
}

cv::Mat decode(std::string_view bytes) {
  try {
    return read_depth(bytes);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception&) {
    throw InputError("damaged EXR, its pixels cannot be decoded");
  }
}

}  // namespace

const ImageCodec kExrCodec = {recognises, inspect, decode};

}  // namespace dxslam
