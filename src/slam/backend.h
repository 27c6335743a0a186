// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#pragma once

#include <string>
#include <vector>

#include "features/extractor.h"
#include "loop_closing/loop_closer.h"
#include "mapping/local_mapper.h"
#include "optimization/may_go_on.h"
#include "relocalization/consensus.h"
#include "relocalization/relocalizer.h"
#include "slam/loop_log.h"
#include "slam/loop_search.h"
#include "slam/system_options.h"

namespace dxslam {

/// Answer to a frame that asks where it is.
struct RelocalizationAnswer {
  RelocalizationReport report;
  LocalMapPtr local_map;  ///< around the place; null if it was not found
};

/// Everything that changes or searches the map: local mapping, loop closing and relocalization
/// (paper, Fig. 1). Owns the map; one thread at a time, unless said otherwise.
class Backend {
 public:
  /// `extractor` makes global descriptors of frames extracted before; it must outlive this.
  /// `pause` is called while the map is worked on, see core/pause.h.
  Backend(const Camera& camera, FeatureExtractor& extractor, const SystemOptions& options,
          const Pause& pause = {});

  /// Goes on with a map made before. The map must be empty so far.
  void load(Map map, std::vector<LoopEdge> closed_loops);

  /// The three steps for a new keyframe, in this order; each returns the local map for tracking to
  /// go on with, the last one null where nothing has moved.
  LocalMapPtr insert(const KeyframeRequest& request);
  LocalMapPtr refine();
  LocalMapPtr close_loops();

  /// Localization only: the local map around the keyframe that shares most points with the frame.
  LocalMapPtr follow(const KeyframeRequest& request);
  /// By the frame alone, or by weak poses of frames in a row that agree.
  RelocalizationAnswer relocalize(const Frame& frame);
  /// The keyframes from now on are of another recording.
  void begin_recording() { mapper_.begin_recording(); }
  /// The frames from now on say where they are anew: forgets weak poses of those before. In the
  /// thread of relocalize().
  void forget_seen() { consensus_.reset(); }

  /// Ends what runs in the background and, if so configured, adjusts the whole map once more; a map
  /// that was only localized in stays as it is. Neither, as soon as `may_go_on` says no. What
  /// changes the map is handed to `change`, which calls it: what is thrown outside of it leaves the
  /// map whole.
  void finish(const MayGoOn& may_go_on, const MapChange& change);

  const Map& map() const { return mapper_.map(); }
  /// Whether changes of the map are taken down from now on (Map::take_changes).
  void record_changes(bool on) {
    if (map().records_changes() != on) mapper_.map().record_changes(on);
  }
  MapChanges take_changes() { return mapper_.map().take_changes(); }
  const std::vector<LoopEdge>& closed_loops() const { return closer_.closed_loops(); }
  const LoopLog& loop_log() const { return loop_log_; }
  const std::string& loop_method() const { return search_.method(); }
  /// Of the keyframe inserted last.
  const MappingReport& report() const { return report_; }

 private:
  FramePtr keyframe_of(const Frame& frame);
  std::vector<float> global_of(const Frame& frame);
  void record(const LoopReport& report, const std::vector<LoopCandidate>& candidates);

  SystemOptions options_;
  FeatureExtractor& extractor_;
  LocalMapper mapper_;
  LoopSearch search_;
  LoopCloser closer_;
  Relocalizer relocalizer_;
  RelocalizationConsensus consensus_;
  GlobalIndex index_;
  MappingReport report_;
  bool grown_ = false;  // a keyframe was inserted, so there is something to adjust
  LoopLog loop_log_;
};

}  // namespace dxslam
