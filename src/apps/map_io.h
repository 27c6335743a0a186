// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <functional>
#include <future>
#include <string>
#include <vector>

#include "core/camera.h"
#include "features/extractor.h"
#include "loop_closing/essential_graph.h"
#include "map_files/map_file.h"
#include "slam/system.h"

namespace dxslam::apps {

/// What a map made now, with this camera and these features, is made with.
MapHeader map_header(const FeatureExtractor& extractor);

/// The loops of a map as its file holds them, and back.
std::vector<StoredLoopEdge> stored_loops(const Map& map, const std::vector<LoopEdge>& loops);
std::vector<LoopEdge> loop_edges(const std::vector<StoredLoopEdge>& stored);

/// Hands a map, read from the file `path`, to the system. Throws InputError if it was made with
/// other features. Returns the pictures in it, one for each of its keyframes' ids; empty strings
/// where there is none.
std::vector<std::string> hand_over(StoredMap stored, System& system, const std::string& path,
                                   const MapHeader& current);

/// Throws InputError if it cannot be saved, and ContractError for an empty map.
void save_system_map(const std::string& path, const MapHeader& header, const Map& map,
                     const std::vector<LoopEdge>& loops,
                     const std::vector<std::string>& thumbnails);

/// Saves a map in a thread of its own, so that mapping need not wait for the disk. A save that
/// fails is said once on stderr; the next one tries again. One thread at a time; nothing is thrown.
class AutoSaver {
 public:
  AutoSaver(std::string path, MapHeader header) : path_(std::move(path)), header_(header) {}
  /// False while a save is under way: the next one has to be left out.
  bool is_ready();
  /// Copies the map and returns. Only when it is ready.
  void save(const Map& map, const std::vector<LoopEdge>& loops,
            const std::vector<std::string>& thumbnails);
  /// Waits for the save under way.
  void finish();

 private:
  void attempt(const std::function<void()>& step);

  std::string path_;
  MapHeader header_;
  bool warned_ = false;
  std::future<void> under_way_;
};

}  // namespace dxslam::apps
