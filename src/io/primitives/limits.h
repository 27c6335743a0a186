// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstddef>
#include <cstdint>

/// The most that one input may hold: one limit per kind, far above what real data need, so that a
/// broken or hostile file costs seconds and not the machine. docs/file_formats.md lists them.
namespace dxslam::limits {

/// A file that is read as a whole (images, models, tables of loops in binary).
inline constexpr std::size_t kFileBytes = std::size_t{256} << 20;
/// A text file that is read line by line (lists, trajectories, matrices).
inline constexpr std::size_t kTextBytes = std::size_t{512} << 20;
/// One line of it; a row of a matrix of 40,000 true loops has some 0.4 MB.
inline constexpr std::size_t kTextLineBytes = std::size_t{4} << 20;
/// A text file of a few numbers, held as a whole (camera matrices, single poses).
inline constexpr std::size_t kSmallTextBytes = std::size_t{1} << 20;
/// Frames of one recording: 18 hours at 30 Hz.
inline constexpr std::size_t kFrames = 2'000'000;
/// Poses of one trajectory: 13 hours at 200 Hz.
inline constexpr std::size_t kPoses = 10'000'000;

/// Messages of a bag: five hours at 1 kHz.
inline constexpr std::size_t kBagMessages = 20'000'000;
/// A chunk or message of a bag, unpacked; usual are 1 MB, a 4K colour image of 16 bits has 50 MB.
inline constexpr std::size_t kBagChunkBytes = std::size_t{512} << 20;
/// Small records of a bag: headers, names and indexes of one chunk.
inline constexpr std::size_t kBagRecordBytes = std::size_t{64} << 20;

/// An image, whose size is looked at before anything is decoded.
inline constexpr std::uint32_t kImageSide = 16384;                     ///< pixels
inline constexpr std::uint64_t kImageArea = std::uint64_t{64} << 20U;  ///< pixels
/// Scans of a progressive JPEG, each of which costs time for the whole area; usual are 10.
inline constexpr int kJpegScans = 64;
/// Memory of a decoder, besides the picture itself.
inline constexpr std::size_t kDecoderBytes = std::size_t{512} << 20;

/// YAML: configurations, calibrations, manifests. Its largest known here has some 250 entries.
inline constexpr std::size_t kYamlBytes = std::size_t{1} << 20;
inline constexpr std::size_t kYamlNodes = 10'000;  ///< scalars, lists, maps and aliases
inline constexpr std::size_t kYamlDepth = 32;      ///< maps and lists inside each other

}  // namespace dxslam::limits
