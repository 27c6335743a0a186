// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/features.h"
#include "core/se3.h"
#include "io/primitives/file_lock.h"
#include "map/map_parts.h"

namespace dxslam {

/// What a map was made with, apart from the cameras, which the map itself knows.
struct MapHeader {
  std::string extractor;  ///< FeatureExtractor::name()
  /// SHA-256 of the network's weights; empty where there is no network or it is not known.
  std::string model_hash;
  DescriptorTraits traits;
};

/// Two keyframes found to see the same place, and where one is in the frame of the other.
struct StoredLoopEdge {
  KeyframeId a = kNoId;
  KeyframeId b = kNoId;
  SE3 a_from_b;
};

/// All that goes into a file, as it was at one moment: shares only frames, which never change, so
/// that another thread may save it while the map lives on.
struct MapSnapshot {
  MapHeader header;
  MapParts parts;
  std::vector<StoredLoopEdge> loops;  ///< between keyframes of one component
  /// JPEG pictures by keyframe, "" where there is none; empty altogether, or one per keyframe.
  std::vector<std::string> thumbnails;
};

/// Copies the map with its ids numbered anew (take_apart). `loops` and `thumbnails` are by the ids
/// of `map`; a loop edge whose keyframe was removed goes to that keyframe's anchor, and is dropped
/// where both ends have become one or are of different components; `thumbnails` may be shorter than
/// the ids go. Points that a file cannot hold (map_limits.h) are left out.
MapSnapshot take_snapshot(const MapHeader& header, const Map& map,
                          const std::vector<StoredLoopEdge>& loops = {},
                          const std::vector<std::string>& thumbnails = {});

/// How a map is written.
struct MapFileOptions {
  /// Float descriptors as they are, four times as large, instead of one byte per number.
  bool exact_descriptors = false;
};

/// Writes the file whole or not at all; temporary files that processes left when they were killed
/// while saving to the same path are removed. Throws, leaving the old file, for what could not be
/// loaded again: InputError if it cannot be written, has no keyframe or holds numbers beyond the
/// bounds of map_limits.h; ContractError for relations that do not hold, and frames that do not fit
/// the header's traits or each other.
void save_map(const std::string& path, const MapSnapshot& snapshot,
              const MapFileOptions& options = {});

/// Throws InputError if save_map() could not write to `path` as things are: for missing folders and
/// permissions, and for a file that is there and is no map, which save_map() does not replace.
/// Changes nothing.
void require_map_target(const std::string& path);
/// The same, and takes `path` for the maps that this process saves there, as long as what is
/// returned lives: throws InputError if another process has it. Nothing for a pipe or terminal.
std::unique_ptr<FileLock> lock_map_target(const std::string& path);

/// A map as it was saved.
struct StoredMap {
  MapHeader header;
  Map map;
  std::vector<StoredLoopEdge> loops;
  std::vector<std::string> thumbnails;  ///< as in MapSnapshot
};

/// Throws InputError, naming the file and what is wrong with it, unless it is a whole and sound map
/// file of a version that this program knows, with a keyframe at least and all numbers within the
/// bounds of map_limits.h.
StoredMap load_map(const std::string& path);

/// The same for a file that is in memory already; `where` stands for it in messages.
StoredMap parse_map(const char* bytes, std::size_t size, const std::string& where);

/// The sections of a file, known to this program or not.
struct MapFileSection {
  std::string id;
  std::uint32_t version = 0;
  std::size_t size = 0;  ///< bytes
};
/// Throws InputError as load_map does for files that are no map files or are not whole.
std::vector<MapFileSection> list_map_sections(const std::string& path);

/// Throws InputError, in which `where` is the map's file and `current` what is in use now, if
/// descriptors of the two cannot be compared: another network, or another extractor.
void require_same_features(const MapHeader& map, const MapHeader& current,
                           const std::string& where);

}  // namespace dxslam
