// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "slam/loop_log.h"

#include <algorithm>

namespace dxslam {

void LoopLog::add(LoopRecord record) {
  accepted_ += record.accepted ? 1 : 0;
  corrections_ += record.effect == "bend" || record.effect == "join" ? 1 : 0;
  records_.push_back(std::move(record));
  if (records_.size() <= most_) return;
  const auto rejected = std::find_if(records_.begin(), records_.end(),
                                     [](const LoopRecord& r) { return !r.accepted; });
  records_.erase(rejected == records_.end() ? records_.begin() : rejected);
  ++forgotten_;
}

}  // namespace dxslam
