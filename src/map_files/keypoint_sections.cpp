// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors

// The sections with what the keyframes' images look like: by far the largest of a map file, so they
// are read in parallel and checked on the way.
#include <fmt/format.h>

#include <cstring>

#include "core/error.h"
#include "core/parallel.h"
#include "map_files/huge_pages.h"
#include "map_files/map_limits.h"
#include "map_files/map_sections.h"

namespace dxslam {
namespace {

constexpr std::size_t kFramesForOneThread = 32;
constexpr std::size_t kNumbers = 5;  // a keypoint: x, y, depth, score, sigma

DescriptorCoding read_coding(SectionReader& reader, bool binary) {
  const auto coding = reader.get<std::uint32_t>();
  const bool fits = binary ? coding == 0 : coding == 1 || coding == 2;
  if (!fits) reader.fail(fmt::format("descriptors of coding {}", coding));
  return static_cast<DescriptorCoding>(coding);
}

template <class Value>
void copy_out(const char*& from, std::vector<Value>& to, std::size_t n) {
  to.resize(n);
  if (n > 0) std::memcpy(static_cast<void*>(to.data()), from, n * sizeof(Value));
  from += n * sizeof(Value);
}

void fill_frame(const char* from, DescriptorCoding coding, const DescriptorTraits& traits,
                Frame& frame) {
  const std::size_t n = frame.size();
  copy_out(from, frame.pixels, n);
  copy_out(from, frame.depths, n);
  copy_out(from, frame.scores, n);
  copy_out(from, frame.sigmas, n);
  const std::size_t size = coded_size(coding, traits.dimension);
  for (int row = 0; row < frame.descriptors.rows; ++row, from += size) {
    decode_descriptor(coding, from, traits.dimension, frame.descriptors.ptr(row));
  }
}

// Descriptors of many frames share one piece of memory, which is freed when the last frame is.
constexpr std::size_t kSharedBytes = std::size_t{16} << 20;

// Gives frames from `first` on their places for descriptors; returns the first that got none.
std::size_t share_descriptors(const std::vector<std::shared_ptr<Frame>>& frames, std::size_t first,
                              const DescriptorTraits& traits) {
  const int type = traits.binary ? CV_8UC1 : CV_32FC1;
  const std::size_t row_bytes =
      static_cast<std::size_t>(traits.dimension) * (traits.binary ? 1 : sizeof(float));
  std::size_t rows = frames[first]->size();
  std::size_t end = first + 1;
  while (end < frames.size() && (rows + frames[end]->size()) * row_bytes <= kSharedBytes) {
    rows += frames[end++]->size();
  }
  cv::Mat shared(static_cast<int>(rows), traits.dimension, type);
  advise_huge_pages(shared.data, rows * row_bytes);
  int row = 0;
  for (std::size_t i = first; i < end; ++i) {
    const int n = static_cast<int>(frames[i]->size());
    // An empty range of rows would forget how wide they are.
    if (n == 0) frames[i]->descriptors.create(0, traits.dimension, type);
    if (n > 0) frames[i]->descriptors = shared.rowRange(row, row + n);
    row += n;
  }
  return end;
}

void check_descriptors(const Frame& frame, const DescriptorTraits& traits) {
  require(frame.size() == 0 ||
              (frame.descriptors.type() == (traits.binary ? CV_8UC1 : CV_32FC1) &&
               frame.descriptors.cols == traits.dimension && frame.descriptors.isContinuous()),
          "descriptors to be saved must be of the kind that the header says");
}

}  // namespace

std::size_t keypoint_size(DescriptorCoding coding, int dimension) {
  return kNumbers * sizeof(float) + coded_size(coding, dimension);
}

void write_keypoints(const MapParts& parts, const DescriptorTraits& traits, DescriptorCoding coding,
                     SectionWriter& file) {
  file.begin(kKeypointsId, kSectionVersion, true);
  file.put(static_cast<std::uint32_t>(coding));
  const std::size_t size = coded_size(coding, traits.dimension);
  for (const Keyframe& k : parts.keyframes) {
    const Frame& f = *k.frame;
    check_descriptors(f, traits);
    file.put_array(reinterpret_cast<const float*>(f.pixels.data()), 2 * f.size());
    file.put_array(f.depths.data(), f.size());
    file.put_array(f.scores.data(), f.size());
    file.put_array(f.sigmas.data(), f.size());
    char* coded = file.put_room(f.size() * size);
    for (int row = 0; row < f.descriptors.rows; ++row, coded += size) {
      encode_descriptor(coding, f.descriptors.ptr(row), traits.dimension, coded);
    }
  }
}

std::size_t keypoint_capacity(SectionReader reader, const DescriptorTraits& traits) {
  const std::size_t size = keypoint_size(read_coding(reader, traits.binary), traits.dimension);
  return reader.left() / size;
}

void read_keypoints(SectionReader reader, const DescriptorTraits& traits, const Rig& rig,
                    const std::vector<std::shared_ptr<Frame>>& frames) {
  const DescriptorCoding coding = read_coding(reader, traits.binary);
  std::vector<std::string_view> records;
  records.reserve(frames.size());
  for (const auto& frame : frames) {
    records.push_back(reader.take(frame->size(), keypoint_size(coding, traits.dimension)));
  }
  reader.expect_end();
  for (std::size_t i = 0; i < frames.size();) i = share_descriptors(frames, i, traits);
  const int threads = frames.size() > kFramesForOneThread ? helpful_threads() : 1;
  in_parallel(frames.size(), threads, [&](std::size_t i) {
    fill_frame(records[i].data(), coding, traits, *frames[i]);
    // What comes out of bytes is of unit length whatever they are.
    const Frame& f = *frames[i];
    const bool possible = coding != DescriptorCoding::kFloat32 ||
                          are_possible_descriptors(f.descriptors.ptr<float>(), f.size(),
                                                   static_cast<std::size_t>(traits.dimension));
    if (!possible || !are_possible_keypoints(f, rig[f.camera])) {
      reader.fail(fmt::format("a keypoint of keyframe {} has impossible numbers", i));
    }
  });
}

void write_globals(const MapParts& parts, const DescriptorTraits& traits, DescriptorCoding coding,
                   SectionWriter& file) {
  const int dimension = traits.global_dimension;
  if (dimension == 0) return;
  file.begin(kGlobalsId, kSectionVersion, false);
  file.put(static_cast<std::uint32_t>(coding));
  for (const Keyframe& k : parts.keyframes) {
    file.put(static_cast<std::uint8_t>(k.frame->global.empty() ? 0 : 1));
  }
  for (const Keyframe& k : parts.keyframes) {
    const std::vector<float>& global = k.frame->global;
    if (global.empty()) continue;
    require(global.size() == static_cast<std::size_t>(dimension),
            "global descriptors to be saved must be of the header's dimension");
    encode_descriptor(coding, global.data(), dimension,
                      file.put_room(coded_size(coding, dimension)));
  }
}

void read_globals(SectionReader reader, const DescriptorTraits& traits,
                  const std::vector<std::shared_ptr<Frame>>& frames) {
  const DescriptorCoding coding = read_coding(reader, false);
  const std::size_t size = coded_size(coding, traits.global_dimension);
  const std::string_view present = reader.take(frames.size(), 1);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (present[i] == 0) continue;
    const std::string_view coded = reader.take(1, size);
    std::vector<float>& global = frames[i]->global;
    global.resize(static_cast<std::size_t>(traits.global_dimension));
    decode_descriptor(coding, coded.data(), traits.global_dimension, global.data());
    if (!are_possible_descriptors(global.data(), 1, global.size())) {
      reader.fail(fmt::format("the global descriptor of keyframe {}", i));
    }
  }
  reader.expect_end();
}

}  // namespace dxslam
