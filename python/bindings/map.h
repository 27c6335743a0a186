// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "bindings/extractor.h"
#include "map_files/map_file.h"
#include "place/global_index.h"

namespace dxslam::python {

/// A map as Python has it: of a file, or of a System that has finished. Nobody changes it.
class MapHandle {
 public:
  MapHandle(MapHeader header, std::shared_ptr<const Map> map, std::vector<StoredLoopEdge> loops,
            std::vector<std::string> thumbnails, std::string name);
  static std::shared_ptr<MapHandle> of(StoredMap stored, std::string name);

  const MapHeader& header() const { return header_; }
  const Map& map() const { return *map_; }
  const std::vector<StoredLoopEdge>& loops() const { return loops_; }
  const std::vector<std::string>& thumbnails() const { return thumbnails_; }
  /// For messages: the file, or what it is.
  const std::string& name() const { return name_; }

  /// Its own, with ids numbered anew; frames are shared.
  StoredMap copy() const;
  /// Of all keyframes; made when it is first asked for. Any thread.
  const GlobalIndex& index() const;
  /// What the map was made with, loaded when it is first asked for. With the GIL.
  SharedExtractor& extractor();

 private:
  MapHeader header_;
  std::shared_ptr<const Map> map_;
  std::vector<StoredLoopEdge> loops_;
  std::vector<std::string> thumbnails_;
  std::string name_;
  mutable std::mutex mutex_;
  mutable std::optional<GlobalIndex> index_;  // guarded by mutex_
  std::optional<SharedExtractor> extractor_;
};

}  // namespace dxslam::python
